//! Writes small sound and unsound inputs to start from: `corpus/<target>/` in the current folder, which is this one.
//! Not part of the crate: what is instrumented for a fuzzer does not link without one.

use std::fs;
use std::path::{Path, PathBuf};

const CUBE: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [20.0, 0.0, 0.0],
    [0.0, 20.0, 0.0],
    [20.0, 20.0, 0.0],
    [0.0, 0.0, 20.0],
    [20.0, 0.0, 20.0],
    [0.0, 20.0, 20.0],
    [20.0, 20.0, 20.0],
];
const SIDES: [[u32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

/// Assignments for `--set`, sound and not.
const ASSIGNMENTS: [&str; 9] = [
    "pillars[0].height=80",
    "views[front].eye=(0,-300,60)",
    "energy=Curvature()",
    "output.camouflage=false",
    "models[0].place=Fit(largest: 20)",
    "pillars[9].height=1",
    "units=",
    "views[].eye=1",
    "a.b[c].d=[1,2",
];

fn main() -> std::io::Result<()> {
    let corpus = Path::new("corpus");
    let scenes = texts(Path::new("../cases"))?;
    let obj = obj();
    write(&corpus.join("obj"), &[obj.clone(), polygons()])?;
    write(&corpus.join("stl"), &[stl_binary(), stl_text()])?;
    write(
        &corpus.join("ply"),
        &[ply_text(), ply_binary(false), ply_binary(true)],
    )?;
    write(&corpus.join("off"), &[off()])?;
    write(&corpus.join("threemf"), &[three_mf(false), three_mf(true)])?;
    write(&corpus.join("scene"), &scenes)?;
    let set = |text: &Vec<u8>| ASSIGNMENTS.map(|a| [a.as_bytes(), b"\n", text].concat());
    write(
        &corpus.join("set"),
        &scenes.iter().take(6).flat_map(set).collect::<Vec<_>>(),
    )?;
    let with_model = |text: &Vec<u8>| [text, b"\0".as_slice(), &obj].concat();
    write(
        &corpus.join("resolve"),
        &scenes.iter().map(with_model).collect::<Vec<_>>(),
    )
}

fn write(folder: &PathBuf, inputs: &[Vec<u8>]) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    for (k, bytes) in inputs.iter().enumerate() {
        fs::write(folder.join(format!("seed-{k}")), bytes)?;
    }
    Ok(())
}

/// The scenes of the test suite, by name.
fn texts(folder: &Path) -> std::io::Result<Vec<Vec<u8>>> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?
        .map(|e| e.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    paths.iter().map(fs::read).collect()
}

fn triangles() -> impl Iterator<Item = [u32; 3]> {
    SIDES
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
}

fn lines<T>(items: impl IntoIterator<Item = T>, line: impl Fn(T) -> String) -> String {
    items.into_iter().map(line).collect()
}

fn obj() -> Vec<u8> {
    let vertices = lines(CUBE, |[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = lines(triangles(), |f| {
        let [a, b, c] = f.map(|v| v + 1);
        format!("f {a} {b} {c}\n")
    });
    (vertices + &faces).into_bytes()
}

/// Quads, relative indices, texture points, a continued line, groups.
fn polygons() -> Vec<u8> {
    let vertices = lines(CUBE, |[x, y, z]| format!("v {x} {y} {z} 1.0\n"));
    let faces = lines(SIDES, |f| {
        let [a, b, c, d] = f.map(|v| i64::from(v) - 8);
        format!("f {a}/1/1 {b}//1 \\\n {c}/1 {d}\n")
    });
    format!("# cube\nmtllib a.mtl\no cube\nvt 0 0\nvn 0 0 1\n{vertices}g side\nusemtl red\ns off\n{faces}")
        .into_bytes()
}

fn stl_binary() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(12u32.to_le_bytes());
    for face in triangles() {
        bytes.extend([0; 12]);
        bytes.extend(
            face.iter()
                .flat_map(|v| CUBE[*v as usize])
                .flat_map(f32::to_le_bytes),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

fn stl_text() -> Vec<u8> {
    let facets = lines(triangles(), |f| {
        let corners = lines(f, |v| {
            let [x, y, z] = CUBE[v as usize];
            format!("vertex {x} {y} {z}\n")
        });
        format!("facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n")
    });
    format!("solid cube\n{facets}endsolid cube\n").into_bytes()
}

fn ply_header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment cube\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nelement face 6\nproperty list uchar int vertex_indices\nelement edge 1\nproperty short a\nend_header\n"
    )
}

fn off() -> Vec<u8> {
    let mut text = "COFF\n8 6 0\n".to_owned();
    for [x, y, z] in CUBE {
        text += &format!("{x} {y} {z} 255 0 0 255\n");
    }
    for [a, b, c, d] in SIDES {
        text += &format!("4 {a} {b} {c} {d} 0.5 0.5 0.5\n");
    }
    text.into_bytes()
}

fn ply_text() -> Vec<u8> {
    let vertices = lines(CUBE, |[x, y, z]| format!("{x} {y} {z} 255\n"));
    let faces = lines(SIDES, |[a, b, c, d]| format!("4 {a} {b} {c} {d}\n"));
    format!("{}{vertices}{faces}7\n", ply_header("ascii")).into_bytes()
}

fn ply_binary(big: bool) -> Vec<u8> {
    let name = if big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let mut parts: Vec<(Vec<[u8; 4]>, Option<u8>, Option<u8>)> = Vec::new();
    parts.extend(CUBE.map(|p| (p.map(f32::to_le_bytes).to_vec(), None, Some(255))));
    parts.extend(SIDES.map(|f| (f.map(u32::to_le_bytes).to_vec(), Some(4), None)));
    let mut bytes = ply_header(name).into_bytes();
    for (numbers, before, after) in parts {
        bytes.extend(before);
        for [a, b, c, d] in numbers {
            bytes.extend(if big { [d, c, b, a] } else { [a, b, c, d] });
        }
        bytes.extend(after);
    }
    bytes.extend([0, 7]);
    bytes
}

/// The model part alone; the target makes an archive of it.
fn three_mf(with_components: bool) -> Vec<u8> {
    let vertices = lines(CUBE, |[x, y, z]| {
        format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")
    });
    let faces = lines(triangles(), |[a, b, c]| {
        format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")
    });
    let (second, id) = if with_components {
        let moved = "transform=\"1 0 0 0 1 0 0 0 1 30 0 0\"";
        let parts = format!("<component objectid=\"1\"/><component objectid=\"1\" {moved}/>");
        (
            format!("<object id=\"2\"><components>{parts}</components></object>"),
            2,
        )
    } else {
        (String::new(), 1)
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><model unit=\"millimeter\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>\
         <object id=\"1\" name=\"a &amp; b\" type=\"model\"><mesh><vertices>{vertices}</vertices>\
         <triangles>{faces}</triangles></mesh></object>{second}</resources><build><item objectid=\"{id}\"/></build></model>"
    )
    .into_bytes()
}
