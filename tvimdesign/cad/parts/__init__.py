"""The parts, each as one solid: those all modes share, those of one mode, and what is bought."""
