//! What a figure wants built.

/// A scene to be built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// Path of the scene without ending, from the folder of the paper's scenes.
    pub scene: String,
    /// Values of it that are changed, as on the command line.
    pub sets: Vec<String>,
    /// Where its files go, from the figures' own folder.
    pub folder: String,
}
