"""Spigot of the link: what it bears by plane mechanics, its parts as drawn, and the choice beside dowel pins."""
