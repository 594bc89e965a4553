"""Parts and materials that vary: tolerances, yields, and optima that hold in spite of them."""
