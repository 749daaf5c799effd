//! A model's file: found, made or fetched.

use std::fs::{self, Permissions};
use std::io::{BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempDir};

use crate::scene::mesh::knot::{DEFAULT_TRIANGLES, knot};
use crate::scene::mesh::{MeshData, ply, write_ply_to};

use super::download::download;

use super::unpack::unpack;
use super::{Model, ModelDirectories, ModelsError, Original, simplify};

/// Provides models in folders.
#[derive(Clone, Debug)]
pub struct Provider {
    /// Where models are looked for and written.
    pub directories: ModelDirectories,
    /// Where downloads start, without a slash at the end; [`STANFORD`](super::STANFORD) or a mirror.
    pub base_url: String,
    /// Whether to make or fetch models that are already there, replacing them in the first folder.
    pub force: bool,
}

/// A model's file that is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provided {
    /// The file.
    pub path: PathBuf,
    /// How it came there.
    pub origin: Origin,
}

/// How a model's file came to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It was there before.
    Found,
    /// It has been generated.
    Made {
        /// Triangles in it.
        triangles: usize,
    },
    /// It has been downloaded.
    Downloaded {
        /// The address.
        url: String,
        /// The SHA-256 of the download.
        sha256: String,
        /// Whether that is the one on record; if not, none is on record.
        verified: bool,
        /// Triangles in the file, after simplification.
        triangles: usize,
    },
}

impl Provider {
    /// Finds the file of `model`, or else writes it to the first folder. The knot is written where
    /// the first folder does not have it; the others where no folder has them.
    ///
    /// # Errors
    /// When the download, its check, its unpacking or the writing fails; no partial file is left.
    pub fn provide(&self, model: Model) -> Result<Provided, ModelsError> {
        let path = self.directories.destination().join(model.file_name());
        let found = match model {
            Model::Knot => Some(path.clone()).filter(|path| path.is_file()),
            Model::Armadillo | Model::Lucy => self.directories.find(model),
        };
        if let Some(path) = found.filter(|_| !self.force) {
            return Ok(Provided {
                path,
                origin: Origin::Found,
            });
        }
        let origin = match model.original() {
            Some(original) => self.fetch(original, &path)?,
            None => {
                let mesh = knot(DEFAULT_TRIANGLES);
                write_mesh(&mesh, &path)?;
                Origin::Made {
                    triangles: mesh.triangles.len(),
                }
            }
        };
        Ok(Provided { path, origin })
    }

    /// Downloads `original`, simplifies it if need be and writes it to `path`.
    pub(super) fn fetch(&self, original: &Original, path: &Path) -> Result<Origin, ModelsError> {
        let url = format!("{}{}", self.base_url, original.path);
        let folder = parent(path)?;
        let work =
            TempDir::with_prefix_in(".cohort-", folder).map_err(ModelsError::write(folder))?;
        let packed = work.path().join("download");
        let sha256 = download(original, &url, &packed)?;
        let unpacked = work.path().join("original.ply");
        unpack(original.packing, &packed, &unpacked, &url)?;
        // Lucy's files take a gigabyte: each goes as soon as it has been read.
        fs::remove_file(&packed).map_err(ModelsError::write(&packed))?;

        let mut mesh = ply::read(&unpacked).map_err(|problem| ModelsError::Mesh {
            url: url.clone(),
            problem: problem.to_string(),
        })?;
        if mesh.triangles.len() != original.triangles {
            return Err(ModelsError::TriangleCount {
                url,
                found: mesh.triangles.len(),
                expected: original.triangles,
            });
        }
        if original.wanted_triangles < original.triangles {
            mesh = simplify(&mesh, original.wanted_triangles)?;
        }
        write_mesh(&mesh, path)?;
        Ok(Origin::Downloaded {
            url,
            sha256,
            verified: original.sha256.is_some(),
            triangles: mesh.triangles.len(),
        })
    }
}

/// Writes `mesh` to `path` under a temporary name that becomes `path` when everything is on disk.
fn write_mesh(mesh: &MeshData, path: &Path) -> Result<(), ModelsError> {
    let folder = parent(path)?;
    let write = || -> std::io::Result<()> {
        // Readable for everybody whom the umask allows, unlike other temporary files.
        let file: NamedTempFile = tempfile::Builder::new()
            .prefix(".cohort-")
            .permissions(Permissions::from_mode(0o666))
            .tempfile_in(folder)?;
        let mut writer = BufWriter::new(file.as_file());
        write_ply_to(&mut writer, mesh)?;
        writer.flush()?;
        drop(writer);
        file.as_file().sync_all()?;
        file.persist(path)?;
        Ok(())
    };
    write().map_err(ModelsError::write(path))
}

/// The folder of a file, made if it is not there.
fn parent(path: &Path) -> Result<&Path, ModelsError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(ModelsError::write(folder))?;
    Ok(folder)
}
