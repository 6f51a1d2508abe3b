//! Rays a second on one core: from an eye, towards a sun, and over a sky, on a printable file or any model.
//!
//!     cargo bench --bench rays -- FILE [--eye X,Y,Z] [--side PIXELS] [--write DIR]
//!
//! Takes a mesh, e.g. a `forest.stl` that was built. The eye stands before its middle at four times its size unless told. Gives a table: rays, how
//! many meet something, million rays a second. With `--write` the same rays go to DIR as little-endian f64, `N` origins and `N`
//! directions of three numbers each (`eye.f64`, `sun.f64`, `sky.f64`), so that other casters can be timed on them.

use glam::DVec3;
use pillarforest::bvh::Bvh;
use pillarforest::geom::ImagePlane;
use pillarforest::intake::load_model;
use pillarforest::mesh::TriMesh;
use pillarforest::render::caster::{sky, sun};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Directions of the sky for every place that the eye sees.
const SKY: usize = 16;
/// Height of the sun, degrees.
const SUN_DEG: f64 = 30.0;
/// Rays of shadows start this far off the surface, millimetres.
const HAIR_MM: f64 = 1e-3;

struct Asked {
    file: PathBuf,
    eye: Option<DVec3>,
    side: usize,
    write: Option<PathBuf>,
}

/// Origins and directions.
type Rays = Vec<(DVec3, DVec3)>;

impl Asked {
    fn read(words: impl Iterator<Item = String>) -> Result<Self, String> {
        let (mut file, mut eye, mut side, mut write) = (None, None, 512, None);
        let mut words = words.filter(|w| w != "--bench");
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word} needs a value"));
            match word.as_str() {
                "--eye" => eye = Some(point(&value()?)?),
                "--side" => side = value()?.parse().map_err(|e| format!("--side: {e}"))?,
                "--write" => write = Some(value()?.into()),
                _ if word.starts_with('-') => return Err(format!("there is no {word}")),
                _ => file = Some(word.into()),
            }
        }
        Ok(Self {
            file: file.ok_or("name a mesh: cargo bench --bench rays -- out/minimal/forest.stl")?,
            eye,
            side,
            write,
        })
    }
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(str::parse).collect();
    match numbers.as_deref() {
        Ok([x, y, z]) => Ok(DVec3::new(*x, *y, *z)),
        _ => Err(format!(
            "--eye takes three numbers, as in 0,-300,50, not {text}"
        )),
    }
}

fn main() -> ExitCode {
    match Asked::read(std::env::args().skip(1)).and_then(|asked| run(&asked)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("error: {what}");
            ExitCode::FAILURE
        }
    }
}

fn run(asked: &Asked) -> Result<(), String> {
    let bytes = fs::read(&asked.file).map_err(|e| format!("{}: {e}", asked.file.display()))?;
    let name = asked.file.to_string_lossy();
    let mesh = load_model(&name, &bytes, false).map_err(|e| format!("{name}: {e:?}"))?;
    let mesh = mesh.value;
    let (lo, hi) = mesh.bounds().ok_or("the mesh is empty")?;
    let (middle, size) = ((lo + hi) / 2.0, (hi - lo).length());
    let eye = asked.eye.unwrap_or(middle - 4.0 * size * DVec3::Y);
    let plane = ImagePlane::looking_at(eye, middle);
    let start = Instant::now();
    let bvh = Bvh::new(&mesh);
    println!(
        "{} triangles, tree in {:.3} s\n",
        mesh.faces.len(),
        start.elapsed().as_secs_f64()
    );
    println!("| rays | number | meet something | million a second |");
    println!("|---|---|---|---|");
    let from_eye = primary(&plane, size / (eye - middle).length() / 2.0, asked.side);
    let first = |(o, d): &(DVec3, DVec3)| bvh.first_hit(*o, *d).is_some();
    timed("eye", &from_eye, &first, asked.write.as_deref())?;
    let towards = sun(&plane, SUN_DEG, true);
    let blocked = |(o, d): &(DVec3, DVec3)| bvh.blocked(*o, *d, f64::INFINITY);
    for (name, directions) in [("sun", vec![towards]), ("sky", sky(SKY))] {
        let rays = shadow(&mesh, &bvh, &from_eye, &directions);
        timed(name, &rays, &blocked, asked.write.as_deref())?;
    }
    Ok(())
}

/// Rays through a square of pixels that spans the mesh.
fn primary(plane: &ImagePlane, reach: f64, side: usize) -> Rays {
    let place = |i: usize| ((i as f64 + 0.5) / side as f64 * 2.0 - 1.0) * reach;
    let pixels = (0..side * side).map(|i| glam::DVec2::new(place(i % side), place(i / side)));
    pixels.map(|q| (plane.eye, plane.direction(q))).collect()
}

/// Rays from all that the eye sees, to the outer side.
fn shadow(mesh: &TriMesh, bvh: &Bvh, from_eye: &Rays, directions: &[DVec3]) -> Rays {
    let seen = from_eye.iter().filter_map(|(o, d)| {
        let hit = bvh.first_hit(*o, *d)?;
        Some((*o + hit.t * *d, mesh.normal_against(hit.face, *d)))
    });
    seen.flat_map(|(place, normal)| {
        let outer = directions.iter().filter(move |w| normal.dot(**w) > 0.0);
        outer.map(move |w| (place + HAIR_MM * (normal + *w), *w))
    })
    .collect()
}

fn timed(
    name: &str,
    rays: &Rays,
    meets: &dyn Fn(&(DVec3, DVec3)) -> bool,
    write: Option<&Path>,
) -> Result<(), String> {
    let start = Instant::now();
    let met = rays.iter().filter(|r| meets(r)).count();
    let rate = rays.len() as f64 / start.elapsed().as_secs_f64() / 1e6;
    println!("| {name} | {} | {met} | {rate:.2} |", rays.len());
    let Some(folder) = write else { return Ok(()) };
    let numbers = rays.iter().map(|r| r.0).chain(rays.iter().map(|r| r.1));
    let bytes: Vec<u8> = numbers
        .flat_map(|v| v.to_array().map(f64::to_le_bytes).concat())
        .collect();
    let path = folder.join(format!("{name}.f64"));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&path, bytes))
        .map_err(|e| format!("{}: {e}", path.display()))
}
