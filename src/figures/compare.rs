//! Against other methods: Figs 10 and 11.

use super::figure::Figure;
use super::findings::Findings;
use super::workshop::{LEAN, Workshop, with};
use crate::compile::OutputFile;
use crate::diagram::chart::{Chart, Line, chart};

pub(crate) const DEPTHS: Figure = Figure {
    name: "fig10",
    paper: "Fig 10",
    title: "A hare in five layers, ever thinner",
    statement: "In a row of reliefs of falling depth the method keeps geometric details that linear scaling of depth loses, even where the relief is extremely thin.",
    make: depths,
};

/// Millimetres.
const DEPTHS_MM: [&str; 5] = ["16", "8", "4", "2", "1"];
/// Name, energy, sRGB (Okabe & Ito).
const SURFACES: [(&str, &str, [u8; 3]); 4] = [
    ("Linear scaling", "Linear", [0xD5, 0x5E, 0x00]),
    ("Curvature", "Curvature()", [0x00, 0x72, 0xB2]),
    ("Normal", "Normal(steps: Never)", [0x00, 0x9E, 0x73]),
    (
        "Normal, torn",
        "Normal(steps: Allowed())",
        [0xCC, 0x79, 0xA7],
    ),
];

fn depths(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let mut lines: Vec<Line> = Vec::new();
    for (name, energy, colour) in SURFACES {
        let mut points = Vec::new();
        for depth in DEPTHS_MM {
            let sets = [
                format!("energy={energy}"),
                format!("supports[0].depth.front={depth}"),
            ];
            let sets = with(&[&sets[0], &sets[1]], &LEAN);
            let case = format!("{name}, {depth} mm");
            let made = shop.build(&case, "fig10-depths", &sets)?;
            let mm = depth.parse().map_err(|_| "a depth is a number")?;
            found.case(&case, &made, &[("depth_mm", mm)])?;
            points.push((mm, made.error_deg()?));
        }
        lines.push(Line {
            name: name.to_owned(),
            colour,
            points,
        });
    }
    let [linear, curvature, normal, _] = &lines[..] else {
        return Err("four surfaces".to_owned());
    };
    for line in [curvature, normal] {
        let pairs = line.points.iter().zip(&linear.points);
        let better = pairs.clone().filter(|(a, b)| a.1 < b.1).count();
        let of = |l: &Line| {
            l.points
                .iter()
                .map(|p| format!("{:.1}", p.1))
                .collect::<Vec<_>>()
                .join(", ")
        };
        found.claim(
            better == DEPTHS_MM.len(),
            format!(
                "{} at {} mm is off by {} degrees, linear scaling by {}",
                line.name,
                DEPTHS_MM.join(", "),
                of(line),
                of(linear)
            ),
        );
    }
    let drawing = chart(&Chart {
        title: "Mean error of the normals, degrees".to_owned(),
        across: "depth of the layer, mm".to_owned(),
        lines,
    });
    let svg = drawing.svg("Errors at five depths").into_bytes();
    found.files.push(OutputFile::new("fig10/depths.svg", svg));
    found.picture("errors at every depth", "fig10/depths.svg".to_owned());
    Ok(())
}

pub(crate) const GRADIENTS: Figure = Figure {
    name: "fig11",
    paper: "Fig 11",
    title: "Against compressed gradients",
    statement: "Beside gradient compression (Weyrich et al. 2007) on the same triangles the results are alike, with fine details kept slightly better, and depth is bounded exactly instead of by scaling afterwards. The print is 24 x 19 cm and protrudes by 8 mm.",
    make: gradients,
};

fn gradients(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let scene = "fig11-gradients";
    let energies = ["Gradient()", "Curvature()", "Normal(steps: Never)"];
    let mut errors = Vec::new();
    for energy in energies {
        let set = format!("energy={energy}");
        let made = shop.build(energy, scene, &with(&[&set], &LEAN))?;
        let front = made.most(|c| c.relief_front_mm)?;
        found.case(energy, &made, &[("relief_front_mm", front)])?;
        errors.push(made.error_deg()?);
    }
    let [gradient, curvature, normal] = [errors[0], errors[1], errors[2]];
    found.claim(
        curvature < gradient,
        format!(
            "the paper's energy: {curvature:.1} degrees off, compressed gradients: {gradient:.1}"
        ),
    );
    found.claim(
        normal < gradient,
        format!(
            "our energy of normals: {normal:.1} degrees off, compressed gradients: {gradient:.1}"
        ),
    );
    let size = shop.build(energies[1], scene, &with(&["energy=Curvature()"], &LEAN))?;
    let [x, _, z] = size.solid()?.size_mm;
    found.note(format!("The plate is {x:.0} x {z:.0} mm. Compressed gradients are our implementation after the published method: attenuation log(1 + alpha g) / alpha, integrated by least squares on the visible triangles, then scaled into the layer; without sharpening."));
    Ok(())
}
