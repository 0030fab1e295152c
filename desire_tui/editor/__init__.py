"""Editor tabs."""
