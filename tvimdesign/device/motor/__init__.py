"""The motor below the module: where its parts are, what they weigh, and what must stay clear of them."""
