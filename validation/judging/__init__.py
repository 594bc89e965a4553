"""Validation cases as data: read, compared, judged, written as a page with figures."""
