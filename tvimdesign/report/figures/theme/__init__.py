"""How every figure looks: colours and lines, the sheet with the study's name, axes with ticks and words."""
