use std::io::Write;
use std::path::PathBuf;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use proptest::prelude::*;

use super::*;

const POSITIONS: [[f32; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];
const FACES: [[u32; 3]; 2] = [[0, 1, 2], [1, 2, 3]];

/// A mesh to be written.
struct Draft {
    version: u16,
    flags: u32,
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    /// Vertices and faces that the header promises.
    counts: [u64; 2],
}

impl Default for Draft {
    fn default() -> Self {
        Self {
            version: 4,
            flags: 0x1000,
            positions: POSITIONS.to_vec(),
            faces: FACES.to_vec(),
            counts: [4, 2],
        }
    }
}

impl Draft {
    /// What is compressed.
    fn content(&self) -> Vec<u8> {
        let mut bytes = self.flags.to_le_bytes().to_vec();
        if self.version == 4 {
            bytes.extend(b"a name\0");
        }
        bytes.extend(self.counts.iter().flat_map(|count| count.to_le_bytes()));
        let mut numbers = |numbers: &mut dyn Iterator<Item = f32>| {
            for number in numbers {
                if self.flags & flags::DOUBLE_PRECISION != 0 {
                    bytes.extend(f64::from(number).to_le_bytes());
                } else {
                    bytes.extend(number.to_le_bytes());
                }
            }
        };
        numbers(&mut self.positions.iter().flatten().copied());
        if self.flags & flags::NORMALS != 0 {
            numbers(&mut [0.0, 0.0, 2.0].into_iter().cycle().take(12));
        }
        if self.flags & flags::TEXTURE_COORDINATES != 0 {
            numbers(&mut [0.25, 0.75].into_iter().cycle().take(8));
        }
        if self.flags & flags::COLOURS != 0 {
            numbers(&mut [0.5; 12].into_iter());
        }
        bytes.extend(
            self.faces
                .iter()
                .flatten()
                .flat_map(|index| index.to_le_bytes()),
        );
        bytes
    }

    fn bytes(&self) -> Vec<u8> {
        wrapped(self.version, &self.content())
    }
}

/// A header and compressed content.
fn wrapped(version: u16, content: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_le_bytes().to_vec();
    bytes.extend(version.to_le_bytes());
    let mut encoder = ZlibEncoder::new(bytes, Compression::default());
    encoder.write_all(content).unwrap();
    encoder.finish().unwrap()
}

/// A file with several meshes.
fn collected(drafts: &[Draft]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut starts = Vec::new();
    for draft in drafts {
        starts.push(bytes.len());
        bytes.extend(draft.bytes());
    }
    for start in starts {
        match drafts[0].version {
            4 => bytes.extend((start as u64).to_le_bytes()),
            _ => bytes.extend((start as u32).to_le_bytes()),
        }
    }
    bytes.extend((drafts.len() as u32).to_le_bytes());
    bytes
}

#[test]
fn both_versions_and_precisions_are_read() {
    for version in [3, 4] {
        for precision in [0, 0x1000, flags::DOUBLE_PRECISION] {
            let plain = Draft {
                version,
                flags: precision,
                ..Draft::default()
            };
            let read = parse(&plain.bytes(), 0).unwrap();
            assert_eq!(read.positions, POSITIONS);
            assert_eq!(read.triangles, FACES);
            assert_eq!((read.normals, read.uvs), (None, None));
            let everything = Draft {
                version,
                flags: precision | 0x1b,
                ..Draft::default()
            };
            let read = parse(&everything.bytes(), 0).unwrap();
            assert_eq!(read.normals, Some(vec![[0.0, 0.0, 1.0]; 4]));
            assert_eq!(read.uvs, Some(vec![[0.25, 0.75]; 4]));
            assert_eq!(read.triangles, FACES);
        }
    }
}

#[test]
fn meshes_are_found_by_their_number() {
    for version in [3, 4] {
        let drafts = [1, 2, 3].map(|faces| Draft {
            version,
            faces: vec![[0, 1, 2]; faces],
            counts: [4, faces as u64],
            ..Draft::default()
        });
        let file = collected(&drafts);
        for index in 0..3 {
            let read = parse(&file, index).unwrap();
            assert_eq!(read.triangles.len(), index as usize + 1);
        }
        let problem = parse(&file, 3).unwrap_err().to_string();
        assert_eq!(
            problem,
            "there is no mesh 3: the file has 3, counted from 0"
        );
    }
}

#[test]
fn what_is_wrong_is_told() {
    let problem = |bytes: &[u8], index| parse(bytes, index).unwrap_err().to_string();
    let draft = Draft::default;
    for (bytes, message) in [
        (vec![], "ends before its header"),
        (b"ply\n".to_vec(), "1c 04"),
        (wrapped(5, b""), "version 5"),
        (wrapped(4, b"\0\0"), "truncated: it ends in header"),
        (wrapped(4, &[1; 64]), "truncated: it ends in header"),
        (
            Draft {
                counts: [0, 2],
                ..draft()
            }
            .bytes(),
            "no vertices",
        ),
        (
            Draft {
                counts: [4, 0],
                ..draft()
            }
            .bytes(),
            "no triangles",
        ),
        (
            Draft {
                counts: [4, u64::MAX],
                ..draft()
            }
            .bytes(),
            "ends in face 2",
        ),
        (
            Draft {
                counts: [u64::MAX, 2],
                ..draft()
            }
            .bytes(),
            "too many",
        ),
        (
            Draft {
                counts: [4_000_000_000, 2],
                ..draft()
            }
            .bytes(),
            "ends in position",
        ),
        (
            Draft {
                faces: vec![[0, 1, 4]; 2],
                ..draft()
            }
            .bytes(),
            "face 0 refers to vertex 4",
        ),
        (
            Draft {
                positions: vec![[f32::NAN; 3]; 4],
                ..draft()
            }
            .bytes(),
            "the position of vertex 0 is not finite",
        ),
        (
            [&[0x1c, 4, 4, 0], &b"no zlib stream"[..]].concat(),
            "damaged",
        ),
    ] {
        let said = problem(&bytes, 0);
        assert!(said.contains(message), "{said}, not {message}");
    }
    let alone = Draft::default().bytes();
    let said = problem(&alone, 7);
    assert!(
        said.contains("damaged") || said.contains("no mesh 7") || said.contains("1c 04"),
        "{said}"
    );
    let mut elsewhere = collected(&[Draft::default(), Draft::default()]);
    let entry = elsewhere.len() - 12;
    elsewhere[entry..entry + 8].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(problem(&elsewhere, 1).contains("list of meshes"));
}

/// `mi.load_dict({'type': 'serialized', 'filename': …, 'shape_index': …})`: counts, and some of the numbers.
#[test]
fn the_preview_scene_is_read_as_mitsuba_does() {
    let Some(suite) = std::env::var_os("COHORT_SUITE") else {
        eprintln!("SKIPPED: COHORT_SUITE does not name the suite");
        return;
    };
    let path = PathBuf::from(suite).join("scenes/matpreview/matpreview.serialized");
    for (index, vertices, faces, first, last) in [
        (
            0,
            289,
            512,
            [-0.504_866_24, 0.574_720_86, 0.784_379],
            [285, 288, 286],
        ),
        (
            1,
            2078,
            3936,
            [0.667_028_55, 0.276_292_26, 0.062_822_94],
            [1861, 2077, 1865],
        ),
        (
            2,
            29439,
            57152,
            [0.047_490_597, -0.449_503_18, -0.902_684_45],
            [29438, 29380, 29428],
        ),
    ] {
        let read = read(&path, index).unwrap();
        assert_eq!(
            (read.positions.len(), read.triangles.len()),
            (vertices, faces)
        );
        assert_eq!(read.positions[0], first);
        assert_eq!(read.triangles[faces - 1], last);
        assert!(read.normals.is_some() && read.uvs.is_some());
    }
    assert!(read(&path, 3).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]
    #[test]
    fn damage_is_an_error_or_another_mesh(
        place in 0.0_f64..1.0,
        value in any::<u8>(),
        end in 0.0_f64..1.2,
        inside in any::<bool>(),
        index in 0_u32..4,
    ) {
        let draft = Draft { flags: 0x100b, ..Draft::default() };
        let mut bytes = if inside {
            let mut content = draft.content();
            let place = (place * content.len() as f64) as usize;
            content[place] = value;
            wrapped(4, &content)
        } else {
            let mut bytes = collected(&[draft, Draft::default()]);
            let place = (place * bytes.len() as f64) as usize;
            bytes[place] = value;
            bytes
        };
        bytes.truncate((end * bytes.len() as f64) as usize);
        if let Ok(read) = parse(&bytes, index) {
            let vertices = read.positions.len() as u32;
            prop_assert!(read.triangles.iter().flatten().all(|&index| index < vertices));
        }
    }
}
