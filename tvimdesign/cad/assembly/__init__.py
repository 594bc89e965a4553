"""The module put together: every part placed, the names of its files, the bill of materials and the assembly note."""
