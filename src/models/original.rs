//! What is on record about the files that Stanford offers.

/// Where the addresses of [`Original`]s start.
pub const STANFORD: &str = "http://graphics.stanford.edu";

/// A file to download, and what it must turn out to be.
#[derive(Clone, Copy, Debug)]
pub struct Original<'a> {
    /// Its address after the base address, with a leading slash.
    pub path: &'a str,
    /// Its size in bytes.
    pub bytes: u64,
    /// Its SHA-256 in lower-case hexadecimal digits, if one is on record.
    pub sha256: Option<&'a str>,
    /// How the PLY lies in it.
    pub packing: Packing,
    /// Triangles of the mesh in it.
    pub triangles: usize,
    /// Triangles of the mesh that the scene wants; not more than `triangles`.
    pub wanted_triangles: usize,
}

/// How a PLY file is packed for its way through the net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// The PLY itself, gzipped.
    Gzip,
    /// The first `.ply` file of a gzipped tar archive.
    TarGzip,
}

/// The Armadillo. The laboratory publishes no checksum; this is the one other projects recorded.
pub(super) const ARMADILLO: Original = Original {
    path: "/pub/3Dscanrep/armadillo/Armadillo.ply.gz",
    bytes: 3_874_291,
    sha256: Some("8b9b56cc36e66d54429b1e1e75bd89e833645bfe0dc7c1afd1205877a7356a3f"),
    packing: Packing::Gzip,
    triangles: 345_944,
    wanted_triangles: 345_944,
};

/// Lucy, of whom no checksum is on record.
pub(super) const LUCY: Original = Original {
    path: "/data/3Dscanrep/lucy.tar.gz",
    bytes: 321_969_388,
    sha256: None,
    packing: Packing::TarGzip,
    triangles: 28_055_742,
    wanted_triangles: 525_814,
};
