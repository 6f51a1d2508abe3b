//! Whether anything of another view stands in a view's sight lines, by rays at the finished solid.
