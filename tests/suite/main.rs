//! Integration tests, one module a subject.

mod hostile;
mod meshes;
mod diagram;
mod formats;
mod golden;
mod render;
mod shapes;
