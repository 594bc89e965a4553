"""From a file to checked text and values that know their place, and mistakes told with it."""
