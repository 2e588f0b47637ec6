//! What a file is, told by its bytes and never by its name.

use super::report_binary;

/// What the first bytes say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sniffed {
    Empty,
    OpenVdb,
    Text,
    SparseBinary,
    /// Known, but not a volume that can be read.
    Foreign {
        found: &'static str,
        advice: &'static str,
    },
}

const SAVE_AS_VDB: &str = "save it as OpenVDB (.vdb) instead";
const NOT_A_VOLUME: &str = "give an OpenVDB, dense ASCII or sparse binary file";

/// Signatures of what people drop by mistake.
const FOREIGN: [(&[u8], &str, &str); 11] = [
    (b"NanoVDB", "a NanoVDB file", SAVE_AS_VDB),
    (
        b"\0\0\0\0VDB ",
        "an OpenVDB file with its bytes reversed",
        SAVE_AS_VDB,
    ),
    (b"\x89PNG", "a PNG picture", NOT_A_VOLUME),
    (b"\xff\xd8\xff", "a JPEG picture", NOT_A_VOLUME),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture", NOT_A_VOLUME),
    (b"\x1f\x8b\x08", "a gzip archive", "unpack it first"),
    (b"PK\x03\x04", "a zip archive", "unpack it first"),
    (b"\x89HDF", "an HDF5 file (perhaps Field3D)", SAVE_AS_VDB),
    (
        b"\xff\xfe",
        "UTF-16 text",
        "save it as plain ASCII or UTF-8",
    ),
    (
        b"\xfe\xff",
        "UTF-16 text",
        "save it as plain ASCII or UTF-8",
    ),
    (
        b"BLENDER",
        "a Blender scene",
        "bake the domain to OpenVDB and give the .vdb files",
    ),
];

/// Bytes of the OpenVDB magic number, little-endian, before its zeros.
const VDB_MAGIC: &[u8] = b" BDV";

/// Tells the format of a file by its first bytes and its length.
pub(super) fn sniff(bytes: &[u8], length: u64) -> Sniffed {
    if bytes.is_empty() {
        return Sniffed::Empty;
    }
    // A count may look like anything: where the length bears it out, no signature contradicts it.
    if report_binary::announced_length(bytes) == Some(length) {
        return Sniffed::SparseBinary;
    }
    if bytes.starts_with(VDB_MAGIC) {
        return Sniffed::OpenVdb;
    }
    if let Some((_, found, advice)) = FOREIGN.iter().find(|(magic, ..)| bytes.starts_with(magic)) {
        return Sniffed::Foreign { found, advice };
    }
    // Sparse binary has no magic number, but its count and coordinates are small integers, so that NUL bytes
    // come soon; no text has them.
    let head = &bytes[..bytes.len().min(256)];
    let is_control = |byte: &u8| *byte < 0x20 && !byte.is_ascii_whitespace();
    if head.iter().any(is_control) {
        Sniffed::SparseBinary
    } else {
        Sniffed::Text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_told_by_their_bytes() {
        assert_eq!(sniff(b"", 0), Sniffed::Empty);
        assert_eq!(sniff(b" BDV\0\0\0\0", 8), Sniffed::OpenVdb);
        assert_eq!(sniff(b"2 2 2\n1\n", 8), Sniffed::Text);
        assert_eq!(sniff(b"\x1b\0\0\0\0\0\0\0", 8), Sniffed::SparseBinary);
    }

    #[test]
    fn foreign_files_are_named() {
        for (bytes, word) in [
            (&b"NanoVDB0"[..], "NanoVDB"),
            (b"\x89PNG\r\n", "PNG"),
            (b"\xff\xfe4\0", "UTF-16"),
            (b"\0\0\0\0VDB \x01", "reversed"),
            (b"\x1f\x8b\x08\0", "gzip"),
        ] {
            let Sniffed::Foreign { found, .. } = sniff(bytes, bytes.len() as u64) else {
                panic!("{word} was not recognised");
            };
            assert!(found.contains(word), "{found}");
        }
    }

    #[test]
    fn a_count_that_the_length_bears_out_is_no_signature() {
        for count in [0xfffe_u64, 0xfeff, 0x8b1f, 0x08_8b1f] {
            let bytes = (count as u32).to_le_bytes();
            assert_eq!(sniff(&bytes, 4 + 44 * count), Sniffed::SparseBinary);
        }
        // A cut list is not taken for an archive, either.
        assert_eq!(sniff(&0x8b1f_u32.to_le_bytes(), 999), Sniffed::SparseBinary);
    }
}
