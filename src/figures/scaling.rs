//! How time grows with a model: a ball of any size on a plate.

/// Vertices of the balls that are built.
pub const SIZES: [usize; 5] = [10_000, 40_000, 160_000, 320_000, 1_000_000];

/// Energies by name.
pub const WAYS: [(&str, &str); 3] = [
    ("the paper's energy", "energy=Curvature()"),
    ("one piece", "energy=Normal(steps: Never)"),
    ("torn", "energy=Normal(steps: Allowed())"),
];

/// The scene, with a model `ball.obj`.
pub const PLATE: &str = r#"(
    title: "A ball on a plate",
    models: [(name: "ball", file: "ball.obj", place: Fit(height: 80, at: (0, 0, 10)))],
    views: [(name: "front", eye: (0, -350, 50), models: ["ball"])],
    supports: [Plate(width: 110, height: 110, depth: (front: 6, back: 2))],
)
"#;

/// The exponent of the power of vertices that fits seconds best, in least squares of logarithms; none for fewer than two sizes.
pub fn exponent(vertices_and_seconds: &[(f64, f64)]) -> Option<f64> {
    let points: Vec<(f64, f64)> = vertices_and_seconds
        .iter()
        .map(|(v, s)| (v.ln(), s.ln()))
        .collect();
    let count = points.len() as f64;
    let mean = |get: fn(&(f64, f64)) -> f64| points.iter().map(get).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let across: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let both: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (across > 0.0).then(|| both / across)
}
