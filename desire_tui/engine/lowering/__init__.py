"""From the nodes of a DYNAMIC segment to a lowered segment: names, kinds, shapes and guards resolved."""
