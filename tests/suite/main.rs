//! Integration tests, one module a subject.

mod hostile;
mod meshes;
