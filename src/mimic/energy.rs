//! What is minimised, and how.

/// What is minimised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Energy {
    /// Normals in log depth on the visible sub-mesh.
    Normal(NormalOptions),
    /// The paper's curvature energy (Eq 9 and 13) on the whole mesh.
    Curvature(CurvatureOptions),
    /// None: the model's depth mixed with that of the layer's middle (Cignoni et al. 1997; the baseline of the paper's Fig 10).
    Linear,
    /// None: gradients of depth attenuated and integrated anew (Weyrich et al. 2007; the paper's Fig 11), then as `Linear`.
    Gradient(GradientOptions),
}

impl Energy {
    /// Whether the depth order of the model's parts is kept on every ray, as a promise.
    pub fn ordering(&self) -> bool {
        match self {
            Self::Normal(o) => o.ordering,
            Self::Curvature(o) => o.ordering,
            Self::Linear | Self::Gradient(_) => false,
        }
    }
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
    /// Rounds of reweighting, which gather the error in few faces: each solves again with every face's weight times
    /// `theta / tan^2 theta` of the last solution (iteratively reweighted least squares for the sum of `theta`).
    pub reweight: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureOptions {
    /// Weight `w` of hidden vertices (paper Eq 13), visible ones count 1.
    pub hidden_weight: f64,
    pub ordering: bool,
    /// With the term `lambda_i / lambda0_i` of Eq 7; without it (Fig 5) compressed parts are to have the model's Laplacians.
    pub scale_invariant: bool,
    /// Whether groups have scales `mu` (Eq 11); without them bounds are absolute (Eq 10).
    pub group_scales: bool,
    /// Keep the division by the mean curvature `H0_i` (Eq 7) that Eq 9 cancels (Fig 7).
    pub mean_curvature: bool,
    /// Most rounds with the Laplacian of the deformed surface (Eq 6, Fig 6); only if scale invariant.
    pub iterate: u32,
    pub form: CurvatureForm,
}

impl CurvatureOptions {
    /// As the paper's results are made: Eq 13 with the weights of Fig 9, orders of Eq 12.
    pub const PAPER: Self = Self {
        hidden_weight: 0.1,
        ordering: true,
        scale_invariant: true,
        group_scales: true,
        mean_curvature: false,
        iterate: 0,
        form: CurvatureForm::Quadratic,
    };
}

/// In what form the curvature energy's program is solved; the optimum is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvatureForm {
    /// As a quadratic program (Eq 14).
    Quadratic,
    /// With a second-order cone (appendix, Eq 17), which the paper's solver found faster.
    Conic,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientOptions {
    /// `alpha` of Weyrich's attenuation `log(1 + alpha g) / alpha` of slopes `g`; 0 leaves them as they are.
    pub compression: f64,
}
