//! What `init` writes: a commented scene and the model it shows.

/// A scene that builds at once beside [`TEMPLATE_MODEL_FILE`].
pub const TEMPLATE: &str = include_str!("template.ron");
/// Where the scene looks for its model, relative to itself.
pub const TEMPLATE_MODEL_FILE: &str = "models/owl.ply";
/// The model: the bundled owl.
pub const TEMPLATE_MODEL: &[u8] = include_bytes!("../../../scenes/models/owl.ply");
