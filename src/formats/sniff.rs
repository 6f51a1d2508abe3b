//! What a file is by its name and its first bytes, and what to do with one that is no model that can be read.

use crate::diag::Diagnostic;
use crate::formats::mesh_format::MeshFormat;

const WANTED: &str = "OBJ, STL, PLY, OFF or 3MF wanted";

/// Programs that read what we do not and write what we do.
const BY_BLENDER: &str =
    "in Blender: File, Import, its format; then File, Export, Wavefront (.obj)";
const BY_CAD: &str = "export triangles from the program it was drawn in (3MF or STL), or in FreeCAD: File, Open; select the body; File, Export, STL";
const BY_PICTURE: &str = "a picture is no model; one of heights goes into a support: Wave(heights: Image(file: \"heights.png\", to: 3))";
const UNPACK: &str = "unpack it first";
const AS_UTF8: &str = "save it as UTF-8 text";

/// The format by the extension, if the content can be that.
///
/// # Errors
/// What is wrong with the name or the content, without the place.
pub(super) fn sniffed(file_name: &str, bytes: &[u8]) -> Result<MeshFormat, Diagnostic> {
    if bytes.is_empty() {
        return Err(Diagnostic::error("the file is empty"));
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Diagnostic::error("the file is empty but for blanks"));
    }
    let content = recognised(bytes);
    let Some(format) = MeshFormat::of(file_name) else {
        return Err(unknown(file_name, content));
    };
    match content {
        Some(content) if content.format != Some(format) => {
            let (name, what) = (format.name(), content.what);
            let message = format!("the extension says {name}, but the content is {what}");
            Err(content.helped(Diagnostic::error(message)))
        }
        _ => Ok(format),
    }
}

/// A name whose extension is none of those read.
fn unknown(file_name: &str, content: Option<Content>) -> Diagnostic {
    let extension = file_name.rsplit_once('.').map(|(_, e)| e);
    let extension = extension.unwrap_or_default().to_ascii_lowercase();
    let by_name = || {
        OTHERS
            .iter()
            .find(|(names, ..)| names.contains(&&*extension))
    };
    match content {
        Some(content) => {
            let message = format!(
                "unknown extension, and the content is {}; {WANTED}",
                content.what
            );
            content.helped(Diagnostic::error(message))
        }
        None => match by_name() {
            Some((_, what, help)) => {
                Diagnostic::error(format!("{what} cannot be read; {WANTED}")).help(*help)
            }
            None => Diagnostic::error(format!("unknown extension; {WANTED}")),
        },
    }
}

/// What is known of formats that are not read, by their extensions.
const OTHERS: [(&[&str], &str, &str); 4] = [
    (&["glb", "gltf"], "a glTF model", BY_BLENDER),
    (
        &[
            "fbx", "dae", "blend", "usd", "usda", "usdc", "usdz", "abc", "3ds", "wrl", "x3d",
            "max", "ma", "mb", "c4d", "lwo", "amf", "vrml",
        ],
        "a model of that format",
        BY_BLENDER,
    ),
    (
        &[
            "step", "stp", "iges", "igs", "brep", "sat", "x_t", "f3d", "sldprt", "sldasm", "ipt",
            "iam", "skp", "3dm", "dwg", "dxf", "fcstd", "scad", "jt", "prt",
        ],
        "a drawing of that format",
        BY_CAD,
    ),
    (
        &[
            "png", "jpg", "jpeg", "gif", "bmp", "tif", "tiff", "webp", "heic",
        ],
        "a picture",
        BY_PICTURE,
    ),
];

/// What the first bytes give away for sure.
#[derive(Clone, Copy)]
struct Content {
    what: &'static str,
    /// If it is one that can be read.
    format: Option<MeshFormat>,
    help: Option<&'static str>,
}

impl Content {
    fn helped(self, diagnostic: Diagnostic) -> Diagnostic {
        match self.help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        }
    }
}

fn recognised(bytes: &[u8]) -> Option<Content> {
    const MODELS: [(&[u8], MeshFormat, &str, &str); 4] = [
        (
            b"PK\x03\x04",
            MeshFormat::ThreeMf,
            "a zip archive (3MF, if it is a model)",
            "unpack it, or name it .3mf if it is one",
        ),
        (
            b"PK\x05\x06",
            MeshFormat::ThreeMf,
            "a zip archive (3MF, if it is a model)",
            "unpack it, or name it .3mf if it is one",
        ),
        (b"ply\n", MeshFormat::Ply, "PLY", "name it .ply"),
        (b"ply\r", MeshFormat::Ply, "PLY", "name it .ply"),
    ];
    const STRANGERS: [(&[u8], &str, Option<&str>); 16] = [
        (b"\x89PNG", "a PNG picture", Some(BY_PICTURE)),
        (b"\xFF\xD8\xFF", "a JPEG picture", Some(BY_PICTURE)),
        (b"GIF8", "a GIF picture", Some(BY_PICTURE)),
        (b"%PDF", "a PDF document", None),
        (b"\x1F\x8B", "gzip-compressed", Some(UNPACK)),
        (b"7z\xBC\xAF", "a 7z archive", Some(UNPACK)),
        (b"Rar!", "a RAR archive", Some(UNPACK)),
        (b"glTF", "a binary glTF model (GLB)", Some(BY_BLENDER)),
        (b"Kaydara FBX", "an FBX model", Some(BY_BLENDER)),
        (b"BLENDER", "a Blender file", Some(BY_BLENDER)),
        (b"#VRML", "a VRML model", Some(BY_BLENDER)),
        (b"\x7FELF", "a program", None),
        (b"\xFF\xFE", "UTF-16 text", Some(AS_UTF8)),
        (b"\xFE\xFF", "UTF-16 text", Some(AS_UTF8)),
        (
            b"version https://git-lfs",
            "a git-lfs pointer, not the model itself",
            Some("run `git lfs pull` in its repository"),
        ),
        (
            b"ISO-10303-21",
            "a STEP drawing: curved surfaces instead of triangles",
            Some(BY_CAD),
        ),
    ];
    let model = MODELS.iter().find(|(magic, ..)| bytes.starts_with(magic));
    if let Some((_, format, what, help)) = model {
        return Some(Content {
            what,
            format: Some(*format),
            help: Some(help),
        });
    }
    let stranger = |what, help| Content {
        what,
        format: None,
        help,
    };
    if let Some((_, what, help)) = STRANGERS
        .iter()
        .find(|(magic, ..)| bytes.starts_with(magic))
    {
        return Some(stranger(what, *help));
    }
    if is_off(bytes) {
        return Some(Content {
            what: "OFF",
            format: Some(MeshFormat::Off),
            help: Some("name it .off"),
        });
    }
    let start = bytes.trim_ascii_start();
    let start = start[..start.len().min(512)].to_ascii_lowercase();
    let has = |word: &[u8]| start.windows(word.len()).any(|w| w == word);
    if start.starts_with(b"<!doctype html") || start.starts_with(b"<html") {
        let help = "an error page saved as a model? download it again";
        return Some(stranger("an HTML page", Some(help)));
    }
    if start.starts_with(b"{") && has(b"\"asset\"") {
        return Some(stranger("a glTF model", Some(BY_BLENDER)));
    }
    (start.starts_with(b"<") && has(b"<collada"))
        .then(|| stranger("a COLLADA model", Some(BY_BLENDER)))
}

/// Whether the first word is `OFF` in one of its forms: `COFF`, `NOFF`, `STCNOFF`.
fn is_off(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let end = start.iter().position(u8::is_ascii_whitespace);
    let word = &start[..end.unwrap_or(start.len())];
    let prefix = word.strip_suffix(b"OFF");
    prefix.is_some_and(|p| p.len() <= 5 && p.iter().all(|b| b"STCN4n".contains(b)))
}
