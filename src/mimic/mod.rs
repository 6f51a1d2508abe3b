//! The optimisation: depths along the eye's rays that keep the model's normals within hard bounds.

/// What is minimised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Energy {
    /// Normals in log depth on the visible sub-mesh.
    Normal(NormalOptions),
    /// The paper's curvature energy (Eq 9 and 13) on the whole mesh.
    Curvature(CurvatureOptions),
}

/// How faces count in [`Energy::Normal`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceWeight {
    /// By surface area (paper Eq 2).
    Area,
    /// By the solid angle the eye sees of it.
    SolidAngle,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalOptions {
    pub weight: FaceWeight,
    /// Keep the depth order of sheets that overlap in the image (paper Eq 12).
    pub ordering: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureOptions {
    /// Weight `w` of hidden vertices (paper Eq 13), visible ones count 1.
    pub hidden_weight: f64,
    pub ordering: bool,
}
