"""The report page: one HTML file that opens offline, made from plain blocks of text, tables, curves and solids."""
