"""`continue`: steady states and limit cycles followed over a parameter, with the places where they change."""
