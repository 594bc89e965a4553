"""What every part is drawn with: dimensions in mm, simple solids, springs, kinds of part and how each is produced."""
