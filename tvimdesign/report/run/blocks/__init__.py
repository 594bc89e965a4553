"""A run's result as blocks: the verdict, requirements, facts, warnings and tables that every renderer shows."""
