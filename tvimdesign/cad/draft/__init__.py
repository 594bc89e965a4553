"""Drafts of a module: meshes good enough to look at, made while a hand moves a control."""
