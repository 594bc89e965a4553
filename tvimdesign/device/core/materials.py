"""Materials of the module: the chosen catalogue records and the numbers taken from them."""

from tvimdesign.device.table import Feature, QuantityGroup

CRYSTALLIZING = (Feature("pcl_freezing", "equilibrium"),)
GLASS = (Feature("pcl_softening", "melting"),)
quantities = QuantityGroup("Materials")

quantities.choices("materials")
