"""States of a study that is explored: messages that change it, what is kept, saved and shown of it."""
