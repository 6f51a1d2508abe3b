//! Contests: surface that two views want, and reliefs that would stand in each other's sight lines.
