"""A design's model held against finite elements on its exported parts, and told."""
