"""The paper's Figure 6: parametric studies of spar and rib, one factor at a time."""
