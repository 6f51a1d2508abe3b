//! Integration tests, one module a subject.

mod architecture;
mod certificates_coverage;
mod cli;
mod diagram;
mod formats;
mod golden;
mod hostile;
mod lights;
mod meshes;
mod numerics;
mod readme;
mod render;
mod scene;
mod scenes;
mod shapes;
mod steps;
mod visibility;
