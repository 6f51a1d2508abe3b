//! In real light: Figs 18 and 19.

use super::figure::Figure;
use super::findings::Findings;
use super::made::Made;
use super::workshop::Workshop;

/// Scenes that are looked at in every light, all of them torn: with normals that are right, what goes wrong is the light's doing.
const SCENES: [(&str, &str, &[&str]); 3] = [
    (
        "fish in the sea",
        "fig13-wave",
        &["energy=Normal(steps: Allowed())"],
    ),
    ("owl on stairs", "fig03-stairs", &[]),
    ("forest, first view", "../four-creatures", &[]),
];
const SUNS: [&str; 3] = ["sun_15", "sun_30", "sun_60"];

pub(crate) const SUN_AND_CLOUD: Figure = Figure {
    name: "fig18",
    paper: "Fig 18",
    title: "Sunny and cloudy days",
    statement: "Under an overcast sky the illusion of depth is perfect; direct sun casts harsh shadows that reveal how thin the reliefs are.",
    make: sun_and_cloud,
};

fn sun_and_cloud(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    for (name, scene, sets) in SCENES {
        let made = shop.build(name, scene, sets)?;
        let rmse = |light: &str| made.in_light(light, |l| Some(l.rmse));
        let measured = [
            ("overcast_rmse", rmse("overcast")?),
            ("sun_60_rmse", rmse("sun_60")?),
            ("sun_30_rmse", rmse("sun_30")?),
            ("sun_15_rmse", rmse("sun_15")?),
            (
                "sun_30_without_shadows_rmse",
                made.in_light("sun_30", |l| Some(l.rmse_unshadowed))?,
            ),
            (
                "sun_30_false_shadow_share",
                made.in_light("sun_30", |l| l.false_shadow_share)?,
            ),
        ];
        found.row(name, &made, &measured, made.keeps_promises());
        sheet(found, name, &made)?;
        let suns = SUNS
            .map(rmse)
            .into_iter()
            .collect::<Result<Vec<f64>, _>>()?;
        let worst = suns.into_iter().fold(0.0, f64::max);
        let cloudy = rmse("overcast")?;
        found.claim(
            cloudy < worst,
            format!("{name}: brightness is off by {cloudy:.0} of 255 under clouds and by up to {worst:.0} in the sun"),
        );
    }
    found.note("Brightness: root mean square over the pixels of the model, 0 to 255, model and solid with their own cast shadows.");
    Ok(())
}

pub(crate) const FLASH: Figure = Figure {
    name: "fig19",
    paper: "Fig 19",
    title: "A flash nearby",
    statement: "A single strobe close to the relief, from the side, breaks the illusion: the method fails there.",
    make: flash,
};

fn flash(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    for (name, scene, sets) in SCENES {
        let made = shop.build(name, scene, sets)?;
        let shading = |light: &str| made.in_light(light, |l| Some(l.rmse_unshadowed));
        let [flash, cloudy] = [shading("flash")?, shading("overcast")?];
        let rmse = |light: &str| made.in_light(light, |l| Some(l.rmse));
        let measured = [
            ("flash_rmse", rmse("flash")?),
            ("flash_without_shadows_rmse", flash),
            (
                "flash_false_shadow_share",
                made.in_light("flash", |l| l.false_shadow_share)?,
            ),
            ("overcast_rmse", rmse("overcast")?),
            ("overcast_without_shadows_rmse", cloudy),
        ];
        found.row(name, &made, &measured, made.keeps_promises());
        sheet(found, name, &made)?;
        found.claim(
            flash > cloudy,
            format!("{name}: shading alone is off by {flash:.0} of 255 in the flash and by {cloudy:.0} under clouds"),
        );
    }
    found.note("Shading alone: without cast shadows. A lamp this near lights a thin relief from other directions and distances than the model, so that even right normals look wrong.");
    Ok(())
}

/// The sheet of the first view in all lights.
fn sheet(found: &mut Findings, name: &str, made: &Made) -> Result<(), String> {
    let path = made.file("sheet of lights", |f| f.ends_with("-lights.png"))?;
    found.picture(name, path);
    Ok(())
}
