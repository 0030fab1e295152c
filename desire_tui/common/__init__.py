"""What several of the rooms above share: configuration, paths, dialogs, themes, names of keys."""
