"""Many designs at once: CasADi functions compiled to run down columns."""
