"""Drafts in 3-D of the module under the hand, in a process of their own."""
