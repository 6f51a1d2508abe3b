//! Integration tests, one module a subject.

mod diagram;
mod formats;
mod golden;
mod hostile;
mod meshes;
mod render;
mod shapes;
mod cli;
mod scene;
