//! Integration tests, one module a subject.

mod diagram;
mod formats;
mod golden;
mod render;
mod shapes;
