"""The link in motion: on springs and dashpots, with contact, friction and play."""
