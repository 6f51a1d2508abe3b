//! What is minimised, and who gets contested surface.

use crate::contest::Contested;
use crate::mimic::{
    CurvatureForm, CurvatureOptions, Energy, FaceWeight, GradientOptions, NormalOptions,
};
use crate::scene::defaults;
use crate::scene::language::raw::{
    RawContested, RawCurvature, RawCurvatureForm, RawEnergy, RawWeight,
};
use crate::scene::text::{Field, Reader};

/// What is minimised, and how.
pub(crate) fn energy(reader: &mut Reader, field: &Field<RawEnergy>) -> Energy {
    match reader.given(field).map(|(energy, _)| energy) {
        None => defaults::ENERGY,
        Some(RawEnergy::Normal(raw)) => {
            let weight = match reader.given(&raw.weight) {
                Some((RawWeight::Area, _)) => FaceWeight::Area,
                Some((RawWeight::SolidAngle, _)) => FaceWeight::SolidAngle,
                None => defaults::NORMAL.weight,
            };
            Energy::Normal(NormalOptions {
                weight,
                ordering: reader.flag(&raw.ordering, defaults::NORMAL.ordering),
                reweight: reader
                    .count(&raw.reweight, "reweight", defaults::REWEIGHT)
                    .map_or(defaults::NORMAL.reweight, |(v, _)| v),
            })
        }
        Some(RawEnergy::Curvature(raw)) => Energy::Curvature(curvature(reader, raw)),
        Some(RawEnergy::Linear) => Energy::Linear,
        Some(RawEnergy::Gradient(raw)) => {
            let compression = reader.within(&raw.compression, "compression", defaults::COMPRESSION);
            Energy::Gradient(GradientOptions {
                compression: compression.map_or(defaults::GRADIENT.compression, |(v, _)| v),
            })
        }
    }
}

fn curvature(reader: &mut Reader, raw: &RawCurvature) -> CurvatureOptions {
    let under = defaults::CURVATURE;
    let hidden_weight = reader.number(&raw.hidden_weight, "hidden_weight");
    if let Some((value, span)) = hidden_weight
        .as_ref()
        .filter(|(v, _)| !(1e-6..=1.0).contains(v))
    {
        reader.error(span, format!("`hidden_weight` is {value}; visible vertices count 1, hidden ones from 0.000001 to 1"));
    }
    let scale_invariant = reader.flag(&raw.scale_invariant, under.scale_invariant);
    let iterate = reader.count(&raw.iterate, "iterate", defaults::ITERATE);
    let rounds = iterate.as_ref().filter(|(rounds, _)| *rounds > 0);
    if let Some((_, span)) = rounds.filter(|_| !scale_invariant) {
        reader.error(span, "`iterate` wants normals, whatever the scale: it goes with `scale_invariant: true` only");
    }
    let form = match reader.given(&raw.form) {
        Some((RawCurvatureForm::Quadratic, _)) => CurvatureForm::Quadratic,
        Some((RawCurvatureForm::Conic, _)) => CurvatureForm::Conic,
        None => under.form,
    };
    CurvatureOptions {
        hidden_weight: hidden_weight.map_or(under.hidden_weight, |(v, _)| v),
        ordering: reader.flag(&raw.ordering, under.ordering),
        scale_invariant,
        group_scales: reader.flag(&raw.group_scales, under.group_scales),
        mean_curvature: reader.flag(&raw.mean_curvature, under.mean_curvature),
        iterate: iterate.map_or(under.iterate, |(v, _)| v),
        form,
    }
}

/// Who gets surface that two views want.
pub(crate) fn contested(reader: &mut Reader, field: &Field<RawContested>) -> Contested {
    match reader.given(field) {
        Some((RawContested::First, _)) => Contested::First,
        Some((RawContested::Largest, _)) => Contested::Largest,
        Some((RawContested::Error, _)) => Contested::Error,
        None => defaults::CONTESTED,
    }
}
