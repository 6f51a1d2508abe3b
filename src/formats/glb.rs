//! Binary glTF 2.0: metres, Y up, faceted, with the viewpoints as cameras.
//!
//! Scene axes map as `(x, y, z) -> (x, z, -y) / 1000`.

use crate::formats::narrow::{count, single};
use crate::formats::part::Part;
use crate::index::FaceId;
use crate::mesh::TriMesh;
use glam::{DMat3, DQuat, DVec3};
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::camera::{Orthographic, Perspective, Type as CameraType};
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::scene::UnitQuaternion;
use gltf_json::validation::{Checked::Valid, USize64};
use gltf_json::{Accessor, Asset, Buffer, Index, Material, Mesh, Node, Root, Scene, buffer};

/// A viewpoint, scene coordinates in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub name: String,
    pub eye: DVec3,
    pub look_at: DVec3,
    pub lens: Lens,
}

/// What a camera's square picture holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Vertical field of view, radians.
    Perspective(f64),
    /// By parallel rays: half the picture's side, millimetres.
    Orthographic(f64),
}

/// Position and normal of a corner, interleaved f32.
const CORNER_BYTES: usize = 24;

/// The bytes of a `.glb` file: one node, mesh and material per part, one node per camera.
///
/// Corners are not shared between faces, so that every viewer shades the facets flat.
pub fn write_glb(parts: &[Part], cameras: &[Camera]) -> Vec<u8> {
    let mut root = Root {
        asset: Asset {
            generator: Some(generator()),
            ..Asset::default()
        },
        ..Root::default()
    };
    let mut binary = Vec::new();
    // glTF forbids empty accessors: an empty part would be one.
    let filled = parts.iter().filter(|p| !p.solid.mesh().faces.is_empty());
    let mut nodes: Vec<Index<Node>> = filled
        .map(|p| push_part(&mut root, &mut binary, p))
        .collect();
    nodes.extend(cameras.iter().map(|c| push_camera(&mut root, c)));
    if !binary.is_empty() {
        root.push(Buffer {
            byte_length: USize64::from(binary.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
    }
    let scene = Scene {
        extensions: None,
        extras: Default::default(),
        name: Some("forest".into()),
        nodes,
    };
    root.scene = Some(root.push(scene));
    frame(serde_json::to_vec(&root).unwrap_or_default(), &binary)
}

fn generator() -> String {
    format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"))
}

/// Millimetres, z up, to metres, y up.
fn metres(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, -p.y) / 1000.0
}

fn push_part(root: &mut Root, binary: &mut Vec<u8>, part: &Part) -> Index<Node> {
    let mesh = part.solid.mesh();
    let view = root.push(buffer::View {
        buffer: Index::new(0),
        byte_length: USize64::from(mesh.faces.len() * 3 * CORNER_BYTES),
        byte_offset: Some(USize64::from(binary.len())),
        byte_stride: Some(buffer::Stride(CORNER_BYTES)),
        name: None,
        target: Some(Valid(buffer::Target::ArrayBuffer)),
        extensions: None,
        extras: Default::default(),
    });
    let (lo, hi) = push_corners(binary, mesh);
    let positions = accessor(view, 0, mesh.faces.len() * 3, Some((lo, hi)));
    let normals = accessor(view, CORNER_BYTES / 2, mesh.faces.len() * 3, None);
    let attributes = [
        (Valid(Semantic::Positions), root.push(positions)),
        (Valid(Semantic::Normals), root.push(normals)),
    ];
    let primitive = Primitive {
        attributes: attributes.into_iter().collect(),
        extensions: None,
        extras: Default::default(),
        indices: None,
        material: Some(root.push(material(&part.name, part.colour))),
        mode: Valid(Mode::Triangles),
        targets: None,
    };
    let mesh = Mesh {
        extensions: None,
        extras: Default::default(),
        name: Some(part.name.clone()),
        primitives: vec![primitive],
        weights: None,
    };
    let mesh = root.push(mesh);
    root.push(Node {
        mesh: Some(mesh),
        name: Some(part.name.clone()),
        ..Node::default()
    })
}

/// Appends every face's corners; gives the smallest and largest position written.
fn push_corners(binary: &mut Vec<u8>, mesh: &TriMesh) -> ([f32; 3], [f32; 3]) {
    binary.reserve(mesh.faces.len() * 3 * CORNER_BYTES);
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for face in FaceId::all(mesh.faces.len()) {
        // glTF wants unit normals, also of the faces that have none.
        let normal = mesh.area_vector(face).try_normalize().unwrap_or(DVec3::Z);
        let normal = DVec3::new(normal.x, normal.z, -normal.y)
            .as_vec3()
            .to_array();
        for corner in mesh.corners(face) {
            let position = metres(corner).as_vec3().to_array();
            for k in 0..3 {
                (lo[k], hi[k]) = (lo[k].min(position[k]), hi[k].max(position[k]));
            }
            position
                .iter()
                .chain(&normal)
                .for_each(|x| binary.extend_from_slice(&x.to_le_bytes()));
        }
    }
    (lo, hi)
}

fn accessor(
    view: Index<buffer::View>,
    offset: usize,
    count: usize,
    range: Option<([f32; 3], [f32; 3])>,
) -> Accessor {
    Accessor {
        buffer_view: Some(view),
        byte_offset: Some(USize64::from(offset)),
        count: USize64::from(count),
        component_type: Valid(GenericComponentType(ComponentType::F32)),
        extensions: None,
        extras: Default::default(),
        type_: Valid(Type::Vec3),
        min: range.map(|(lo, _)| lo.to_vec().into()),
        max: range.map(|(_, hi)| hi.to_vec().into()),
        name: None,
        normalized: false,
        sparse: None,
    }
}

/// A matt material of an sRGB colour (glTF's factors are linear).
fn material(name: &str, colour: [u8; 3]) -> Material {
    let [r, g, b] = colour.map(|c| {
        let c = f32::from(c) / 255.0;
        if c <= 0.04045 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    });
    let pbr = PbrMetallicRoughness {
        base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
        metallic_factor: StrengthFactor(0.0),
        roughness_factor: StrengthFactor(0.9),
        ..PbrMetallicRoughness::default()
    };
    Material {
        name: Some(name.to_owned()),
        pbr_metallic_roughness: pbr,
        ..Material::default()
    }
}

/// A glTF camera looks along its own -Z with +Y up.
fn push_camera(root: &mut Root, camera: &Camera) -> Index<Node> {
    let (eye, target) = (metres(camera.eye), metres(camera.look_at));
    let forward = (target - eye).try_normalize().unwrap_or(DVec3::NEG_Z);
    let right = forward.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, right.cross(forward), -forward));
    let distance = eye.distance(target).max(1e-3);
    let (znear, zfar) = (single(distance / 100.0), single(distance * 10.0));
    let (perspective, orthographic, type_) = match camera.lens {
        Lens::Perspective(fov) => {
            let lens = Perspective {
                aspect_ratio: Some(1.0),
                yfov: single(fov),
                zfar: Some(zfar),
                znear,
                extensions: None,
                extras: Default::default(),
            };
            (Some(lens), None, CameraType::Perspective)
        }
        Lens::Orthographic(half) => {
            let half = single(half / 1000.0);
            let lens = Orthographic {
                xmag: half,
                ymag: half,
                zfar,
                znear,
                extensions: None,
                extras: Default::default(),
            };
            (None, Some(lens), CameraType::Orthographic)
        }
    };
    let index = root.push(gltf_json::Camera {
        name: Some(camera.name.clone()),
        orthographic,
        perspective,
        type_: Valid(type_),
        extensions: None,
        extras: Default::default(),
    });
    root.push(Node {
        camera: Some(index),
        name: Some(camera.name.clone()),
        rotation: Some(UnitQuaternion(rotation.as_quat().to_array())),
        translation: Some(eye.as_vec3().to_array()),
        ..Node::default()
    })
}

/// The container: a 12-byte header, the JSON chunk padded with spaces, the binary chunk (left out if empty).
fn frame(mut json: Vec<u8>, binary: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let binary_bytes = if binary.is_empty() {
        0
    } else {
        8 + binary.len()
    };
    let total = 12 + 8 + json.len() + binary_bytes;
    let mut glb = Vec::with_capacity(total);
    glb.extend_from_slice(b"glTF");
    glb.extend_from_slice(&2u32.to_le_bytes());
    glb.extend_from_slice(&count(total).to_le_bytes());
    glb.extend_from_slice(&count(json.len()).to_le_bytes());
    glb.extend_from_slice(b"JSON");
    glb.extend_from_slice(&json);
    if !binary.is_empty() {
        glb.extend_from_slice(&count(binary.len()).to_le_bytes());
        glb.extend_from_slice(b"BIN\0");
        glb.extend_from_slice(binary);
    }
    glb
}
