"""Parts of the structure: how stiff and strong they are."""
