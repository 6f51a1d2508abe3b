//! Whether the forest can be printed: walls, gaps, overhangs, slenderness, bed, loose parts, core.
