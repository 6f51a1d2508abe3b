//! Integration tests, one module a subject.

mod architecture;
mod camouflage;
mod certificates_coverage;
mod cli;
mod dense;
mod diagram;
mod files;
mod formats;
mod golden;
mod guarantees;
mod hostile;
mod lights;
mod meshes;
mod numerics;
mod printability;
mod properties;
mod readme;
mod render;
mod report_html;
mod scene;
mod scenes;
mod shapes;
mod split;
mod steps;
mod tolerance;
mod visibility;
