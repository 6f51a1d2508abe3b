//! Writers: what other programs will read in the bytes.

use crate::shapes::{BLUE, ORANGE, ball, prism, ring};
use glam::{DQuat, DVec2, DVec3};
use gltf_json::validation::Validate;
use pillarforest::formats::{
    Camera, Lens, Metadata, Part, ZipTime, read_bodies, read_mesh, write_3mf, write_glb, write_stl,
};
use pillarforest::index::{FaceId, VertexId};
use pillarforest::mesh::Solid;
use quick_xml::events::{BytesStart, Event};
use std::io::Read;

fn solids() -> [Solid; 3] {
    [
        Solid::new(prism(&ring(DVec2::new(3.0, -4.0), 2.5, 17), -1.0, 9.7)).unwrap(),
        Solid::new(ball(DVec3::new(10.0, 0.1, 7.0), 3.3, 9)).unwrap(),
        Solid::new(ball(DVec3::new(-10.0, 1e-5, 7.0), 1.0 / 3.0, 5)).unwrap(),
    ]
}

fn parts(solids: &[Solid; 3]) -> Vec<Part<'_>> {
    let part = |name: &str, colour, solid| Part {
        name: name.to_owned(),
        colour,
        solid,
    };
    vec![
        part("base & pillars", [0xDD; 3], &solids[0]),
        part("view \"<owl>\"\u{1}\u{FFFF}'s", ORANGE, &solids[1]),
        part("höre", ORANGE, &solids[2]),
    ]
}

#[test]
fn stl_has_the_layout_and_the_bits_of_the_mesh() {
    let [solid, ..] = solids();
    let bytes = write_stl(
        &solid,
        "solid \u{e9} title that is much longer than the eighty bytes that a header has room for",
    );
    let mesh = solid.mesh();
    assert!(!bytes.starts_with(b"solid"));
    assert!(bytes[..80].is_ascii());
    assert_eq!(
        u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize,
        mesh.faces.len()
    );
    assert_eq!(bytes.len(), 84 + 50 * mesh.faces.len());
    for (face, record) in FaceId::all(mesh.faces.len()).zip(bytes[84..].chunks_exact(50)) {
        let floats: Vec<f32> = record[..48]
            .chunks_exact(4)
            .map(|c| f32::from_le_bytes(c.try_into().unwrap()))
            .collect();
        let corners: Vec<f32> = mesh
            .corners(face)
            .iter()
            .flat_map(|p| p.as_vec3().to_array())
            .collect();
        assert_eq!(&floats[3..], &corners[..]);
        let normal = DVec3::new(floats[0].into(), floats[1].into(), floats[2].into());
        assert!(normal.distance(mesh.normal(face)) < 1e-6);
        assert_eq!(&record[48..], [0, 0]);
    }
}

fn package(bytes: &[u8]) -> Vec<(String, String, Vec<u8>)> {
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    (0..zip.len())
        .map(|k| {
            let mut file = zip.by_index(k).unwrap();
            let mut content = Vec::new();
            file.read_to_end(&mut content).unwrap();
            (
                file.name().to_owned(),
                file.last_modified().unwrap().to_string(),
                content,
            )
        })
        .collect()
}

fn attribute(element: &BytesStart, name: &str) -> String {
    element
        .try_get_attribute(name)
        .unwrap()
        .unwrap_or_else(|| panic!("no {name}"))
        .unescape_value()
        .unwrap()
        .into_owned()
}

/// What a reader finds in a model file.
#[derive(Default)]
struct Model {
    unit: String,
    metadata: Vec<(String, String)>,
    /// Id and colours.
    groups: Vec<(String, Vec<String>)>,
    objects: Vec<Object>,
    items: Vec<String>,
}

#[derive(Default)]
struct Object {
    id: String,
    name: String,
    pid: String,
    vertices: Vec<[f32; 3]>,
    faces: Vec<[VertexId; 3]>,
}

fn read_model(xml: &[u8]) -> Model {
    let mut reader = quick_xml::Reader::from_reader(xml);
    let (mut model, mut buffer, mut in_metadata) = (Model::default(), Vec::new(), false);
    loop {
        match reader.read_event_into(&mut buffer).unwrap() {
            Event::Eof => return model,
            Event::End(e) if e.name().as_ref() == b"metadata" => in_metadata = false,
            Event::Text(text) if in_metadata => {
                model.metadata.last_mut().unwrap().1 += &text.decode().unwrap();
            }
            Event::GeneralRef(entity) if in_metadata => {
                let name = entity.decode().unwrap();
                model.metadata.last_mut().unwrap().1 +=
                    quick_xml::escape::resolve_predefined_entity(&name).unwrap();
            }
            Event::Start(e) | Event::Empty(e) => {
                match e.name().as_ref() {
                    b"model" => model.unit = attribute(&e, "unit"),
                    b"metadata" => {
                        in_metadata = true;
                        model.metadata.push((attribute(&e, "name"), String::new()));
                    }
                    b"m:colorgroup" => model.groups.push((attribute(&e, "id"), Vec::new())),
                    b"m:color" => model
                        .groups
                        .last_mut()
                        .unwrap()
                        .1
                        .push(attribute(&e, "color")),
                    b"object" => {
                        assert_eq!(attribute(&e, "pindex"), "0");
                        model.objects.push(Object {
                            id: attribute(&e, "id"),
                            name: attribute(&e, "name"),
                            pid: attribute(&e, "pid"),
                            ..Object::default()
                        });
                    }
                    b"vertex" => model
                        .objects
                        .last_mut()
                        .unwrap()
                        .vertices
                        .push(["x", "y", "z"].map(|n| attribute(&e, n).parse().unwrap())),
                    b"triangle" => model.objects.last_mut().unwrap().faces.push(
                        ["v1", "v2", "v3"].map(|n| VertexId(attribute(&e, n).parse().unwrap())),
                    ),
                    b"item" => {
                        assert_eq!(e.attributes().count(), 1, "no transform");
                        model.items.push(attribute(&e, "objectid"));
                    }
                    b"resources" | b"mesh" | b"vertices" | b"triangles" | b"build" => {}
                    other => panic!("unexpected element {}", String::from_utf8_lossy(other)),
                }
            }
            _ => {}
        }
        buffer.clear();
    }
}

#[test]
fn a_3mf_holds_named_coloured_objects_with_the_bits_of_their_meshes() {
    let solids = solids();
    let meta = Metadata {
        title: "Groves' & <more>".into(),
        application: "pillarforest 0.1".into(),
        own: vec![("vie ws\"".into(), "3 < 4".into())],
        ..Metadata::default()
    };
    let files = package(&write_3mf(&parts(&solids), &meta, None));
    assert_eq!(
        files.iter().map(|f| f.0.as_str()).collect::<Vec<_>>(),
        ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]
    );
    let model = read_model(&files[2].2);
    assert_eq!(model.unit, "millimeter");
    let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
    assert_eq!(
        model.metadata,
        [
            pair("Title", "Groves' & <more>"),
            pair("Application", "pillarforest 0.1"),
            pair("pillarforest:views", "3 < 4")
        ]
    );
    // One group per different colour, one colour in each.
    let colours: Vec<&[String]> = model.groups.iter().map(|g| g.1.as_slice()).collect();
    assert_eq!(colours, [["#DDDDDDFF"], ["#E69F00FF"]]);
    assert_eq!(
        model
            .objects
            .iter()
            .map(|o| o.name.as_str())
            .collect::<Vec<_>>(),
        ["base & pillars", "view \"<owl>\"'s", "höre"]
    );
    assert_eq!(
        model.objects.iter().map(|o| &o.pid).collect::<Vec<_>>(),
        [&model.groups[0].0, &model.groups[1].0, &model.groups[1].0]
    );
    assert_eq!(
        model.items,
        model
            .objects
            .iter()
            .map(|o| o.id.clone())
            .collect::<Vec<_>>()
    );
    let mut ids: Vec<&String> = model
        .groups
        .iter()
        .map(|g| &g.0)
        .chain(model.objects.iter().map(|o| &o.id))
        .collect();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), 5, "ids are unique over all resources");
    for (object, solid) in model.objects.iter().zip(&solids) {
        let bits: Vec<[f32; 3]> = solid
            .mesh()
            .vertices
            .iter()
            .map(|v| v.as_vec3().to_array())
            .collect();
        assert_eq!(object.vertices, bits);
        assert_eq!(object.faces, solid.mesh().faces);
    }
}

#[test]
fn a_thumbnail_has_a_content_type_and_a_relationship() {
    let solids = solids();
    let files = package(&write_3mf(
        &parts(&solids),
        &Metadata::default(),
        Some(b"png bytes"),
    ));
    let text = |k: usize| String::from_utf8(files[k].2.clone()).unwrap();
    assert!(text(0).contains("Extension=\"png\" ContentType=\"image/png\""));
    assert!(text(1).contains("Target=\"/Metadata/thumbnail.png\""));
    assert_eq!(
        (files[3].0.as_str(), files[3].2.as_slice()),
        ("Metadata/thumbnail.png", &b"png bytes"[..])
    );
}

#[test]
fn a_3mf_knows_no_clock() {
    let solids = solids();
    let write = |created| {
        write_3mf(
            &parts(&solids),
            &Metadata {
                created,
                ..Metadata::default()
            },
            None,
        )
    };
    assert_eq!(write(None), write(None));
    assert!(
        package(&write(None))
            .iter()
            .all(|f| f.1 == "1980-01-01 00:00:00")
    );
    let dated = package(&write(Some(ZipTime::from_unix(1_700_000_000))));
    assert!(
        dated.iter().all(|f| f.1 == "2023-11-14 22:13:20"),
        "{}",
        dated[0].1
    );
    assert_eq!(
        read_model(&dated[2].2).metadata,
        [("CreationDate".to_owned(), "2023-11-14".to_owned())]
    );
}

#[test]
fn days_follow_each_other() {
    let day = |days: u64| {
        let t = ZipTime::from_unix(86_400 * days);
        (t.year, t.month, t.day)
    };
    assert_eq!(day(0), (1980, 1, 1), "zip knows no earlier year");
    assert_eq!(day(u64::MAX / 86_400), (2107, 12, 31), "and no later one");
    let mut expected = (1980, 1, 1);
    for days in 3652..3652 + 128 * 365 + 31 {
        assert_eq!(day(days), expected);
        let (y, m, d) = expected;
        let leap = y % 4 == 0 && (y % 100 != 0 || y % 400 == 0);
        let length = [
            31,
            28 + u8::from(leap),
            31,
            30,
            31,
            30,
            31,
            31,
            30,
            31,
            30,
            31,
        ][usize::from(m) - 1];
        expected = if d < length {
            (y, m, d + 1)
        } else if m < 12 {
            (y, m + 1, 1)
        } else {
            (y + 1, 1, 1)
        };
    }
}

fn chunks(glb: &[u8]) -> (gltf_json::Root, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let json = word(12);
    assert_eq!((&glb[16..20], json % 4), (&b"JSON"[..], 0));
    let root = serde_json::from_slice(&glb[20..20 + json]).unwrap();
    let binary = glb.get(28 + json..).unwrap_or_default();
    (root, binary)
}

#[test]
fn a_glb_is_valid_in_metres_and_faceted() {
    let solids = solids();
    let glb = write_glb(&parts(&solids), &[]);
    let (root, binary) = chunks(&glb);
    let mut problems = Vec::new();
    root.validate(&root, gltf_json::Path::new, &mut |path, error| {
        problems.push(format!("{}: {error}", path()));
    });
    assert!(problems.is_empty(), "{problems:?}");
    for (k, solid) in solids.iter().enumerate() {
        let view = &root.buffer_views[k];
        let start = view.byte_offset.unwrap().0 as usize;
        let bytes = &binary[start..start + view.byte_length.0 as usize];
        let floats: Vec<f64> = bytes
            .chunks_exact(4)
            .map(|c| f32::from_le_bytes(c.try_into().unwrap()).into())
            .collect();
        let corners: Vec<(DVec3, DVec3)> = floats
            .chunks_exact(6)
            .map(|c| (DVec3::from_slice(&c[..3]), DVec3::from_slice(&c[3..])))
            .collect();
        let mut volume = 0.0;
        for t in corners.chunks_exact(3) {
            let normal = (t[1].0 - t[0].0).cross(t[2].0 - t[0].0).normalize();
            assert!(
                t.iter().all(|c| c.1.distance(normal) < 1e-3),
                "normals are those of the facets"
            );
            volume += t[0].0.dot(t[1].0.cross(t[2].0)) / 6.0;
        }
        assert!(
            (1e9 * volume / solid.volume_mm3() - 1.0).abs() < 1e-4,
            "cubic metres, and not mirrored"
        );
        let lowest = corners.iter().map(|c| c.0.y).fold(f64::INFINITY, f64::min);
        assert!((1e3 * lowest - solid.bounds().0.z).abs() < 1e-4, "Y is up");
    }
}

#[test]
fn glb_cameras_stand_at_the_eyes_and_look_at_their_targets() {
    let cameras = [
        Camera {
            name: "owl".into(),
            eye: DVec3::new(250.0, 30.0, 48.0),
            look_at: DVec3::new(0.0, -10.0, 40.0),
            lens: Lens::Perspective(0.5),
        },
        Camera {
            name: "from above".into(),
            eye: DVec3::new(0.0, 0.0, 300.0),
            look_at: DVec3::ZERO,
            lens: Lens::Orthographic(40.0),
        },
    ];
    let glb = write_glb(&[], &cameras);
    let (root, binary) = chunks(&glb);
    assert!(binary.is_empty() && root.buffers.is_empty());
    for (node, camera) in root.nodes.iter().zip(&cameras) {
        let metres = |p: DVec3| DVec3::new(p.x, p.z, -p.y) / 1000.0;
        let at = DVec3::from_array(node.translation.unwrap().map(f64::from));
        assert!(at.distance(metres(camera.eye)) < 1e-6);
        let ahead = DQuat::from_array(node.rotation.unwrap().0.map(f64::from)) * DVec3::NEG_Z;
        assert!(ahead.distance((metres(camera.look_at) - metres(camera.eye)).normalize()) < 1e-6);
        assert_eq!(node.name.as_ref(), Some(&camera.name));
    }
    let owl = DQuat::from_array(root.nodes[0].rotation.unwrap().0.map(f64::from));
    assert!(
        (owl * DVec3::X).y.abs() < 1e-6 && (owl * DVec3::Y).y > 0.9,
        "upright"
    );
    assert_eq!(root.cameras[0].perspective.as_ref().unwrap().yfov, 0.5);
    let parallel = root.cameras[1].orthographic.as_ref().unwrap();
    assert_eq!([parallel.xmag, parallel.ymag], [0.04; 2]);
    assert!(root.cameras[1].perspective.is_none() && parallel.znear < 0.3 && parallel.zfar > 0.3);
}

#[test]
fn colours_of_a_glb_are_linear() {
    let [solid, ..] = solids();
    let glb = write_glb(
        &[Part {
            name: "x".into(),
            colour: BLUE,
            solid: &solid,
        }],
        &[],
    );
    let factor = chunks(&glb).0.materials[0]
        .pbr_metallic_roughness
        .base_color_factor
        .0;
    // From tables of the sRGB curve.
    for (found, wanted) in factor.iter().zip([0.0931, 0.4564, 0.8148, 1.0]) {
        assert!((found - wanted).abs() < 1e-3, "{factor:?}");
    }
}

#[test]
fn our_readers_find_what_our_writers_wrote() {
    let solids = solids();
    let stl = read_mesh("forest.stl", &write_stl(&solids[1], "ball")).unwrap();
    let body = Solid::new(stl.value).unwrap();
    assert_eq!(body.mesh().faces.len(), solids[1].mesh().faces.len());
    assert!((body.volume_mm3() - solids[1].volume_mm3()).abs() < 1e-9);
    let package = write_3mf(&parts(&solids), &Metadata::default(), None);
    let bodies = read_bodies("forest.3mf", &package).unwrap();
    assert!(stl.warnings.is_empty() && bodies.warnings.is_empty());
    assert_eq!(bodies.value.len(), solids.len());
    for (body, solid) in bodies.value.iter().zip(&solids) {
        // The decimals stand for f32 values; read as f64 they are a hair off.
        assert_eq!(Solid::new(body.mesh.clone()).unwrap().mesh(), solid.mesh());
    }
}
