"""Areas, volumes and inertias of simple shapes."""
