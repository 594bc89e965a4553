"""Files of instruments, loggers and spreadsheets as tables of named columns in SI; what was understood can be shown."""
