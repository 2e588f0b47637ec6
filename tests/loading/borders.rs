//! Files that are longer than what is read at once: nothing is lost, doubled or told of a wrong line where parts meet.

use std::fmt::Write;
use std::path::Path;

use glam::IVec3;
use sootlight::volume::{Grid, Limits, Volume, VolumeError, open};

use super::{grid, voxels, write};

/// Sides of a box whose values take several blocks of text.
const DIMS: IVec3 = IVec3::new(101, 97, 93);

fn value_at(voxel: IVec3) -> f32 {
    let i = voxel.x + DIMS.x * (voxel.y + DIMS.y * voxel.z);
    // Of 1 to 8 digits, so that borders fall anywhere in a number.
    [i, i % 7, i % 1000, 10 * i][i as usize % 4] as f32
}

/// The numbers of the box, parted in all the ways that a text may part them: a line for each that ends in a line break.
fn numbers() -> Vec<String> {
    let parts = ["\n", " ", "\r\n", "\t", "\r", "  \n"];
    voxels(IVec3::ZERO, DIMS)
        .enumerate()
        .map(|(i, voxel)| format!("{}{}", value_at(voxel), parts[i % parts.len()]))
        .collect()
}

fn lines_of(text: &str) -> usize {
    text.replace("\r\n", "\n").matches(['\n', '\r']).count()
}

fn dense(folder: &Path, numbers: &[String]) -> Result<Volume, VolumeError> {
    let header = format!("{} {} {}\n", DIMS.x, DIMS.y, DIMS.z);
    read(folder, "density.txt", header + &numbers.concat())
}

/// What is wrong with a file.
fn told(read: Result<Volume, VolumeError>) -> String {
    read.map(|volume| volume.notes).unwrap_err().to_string()
}

/// Reads with one thread and with three, which must come to the same.
fn read(folder: &Path, name: &str, text: impl AsRef<[u8]>) -> Result<Volume, VolumeError> {
    assert!(text.as_ref().len() > 4 << 20, "no more than a block");
    let path = write(folder, name, text);
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let read = || open(std::slice::from_ref(&path), &Limits::default());
        pool.unwrap().install(read)
    });
    match (&one, &three) {
        (Ok(one), Ok(three)) => {
            assert_eq!(one.notes, three.notes);
            assert!(one.grids[0].bricks().eq(three.grids[0].bricks()));
        }
        (Err(one), Err(three)) => assert_eq!(one.to_string(), three.to_string()),
        (one, three) => panic!("{:?} and {:?}", one.as_ref().err(), three.as_ref().err()),
    }
    three
}

fn assert_holds(grid: &Grid, list: impl Iterator<Item = (IVec3, f32)>) {
    for (voxel, value) in list {
        assert_eq!(grid.value(voxel), value, "{voxel}");
    }
}

#[test]
fn a_long_dense_text_gives_every_value_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let volume = dense(folder.path(), &numbers()).unwrap();
    let density = grid(&volume, "density");
    assert_eq!(density.bounds().dims(), DIMS);
    let all = voxels(IVec3::ZERO, DIMS);
    assert_holds(density, all.map(|voxel| (voxel, value_at(voxel))));
}

#[test]
fn a_fault_anywhere_in_a_long_text_is_told_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let mut numbers = numbers();
    let all = numbers.len();
    // The later of two faults is there from the beginning: the earlier one is told.
    numbers[all - 2].insert(0, 'x');
    for at in [0, 1, 5_431, 6_000, 400_000, 700_000, all - 2] {
        let right = std::mem::replace(&mut numbers[at], "1,5 ".to_owned());
        let error = told(dense(folder.path(), &numbers));
        let line = 2 + lines_of(&numbers[..at].concat());
        assert!(
            error.contains(&format!("line {line}: ")),
            "{at}, {line}: {error}"
        );
        assert!(error.contains("1,5"), "{error}");
        numbers[at] = right;
    }
}

#[test]
fn the_values_of_a_long_text_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let numbers = numbers();
    let all = numbers.len();
    let missing = dense(folder.path(), &numbers[..all - 1]);
    let mut more = numbers.clone();
    // What is too much is only counted.
    more.extend(["x ".to_owned(), "8 ".to_owned()]);
    for (result, found) in [(missing, all - 1), (dense(folder.path(), &more), all + 2)] {
        let error = told(result);
        assert!(error.contains(&format!("found {found};")), "{error}");
    }
}

#[test]
fn a_number_longer_than_a_block_is_a_number() {
    let folder = tempfile::tempdir().unwrap();
    let zeros = "0".repeat(9 << 20);
    let text = format!("3 1 1\n1 {zeros}2 3\n");
    let volume = read(folder.path(), "density.txt", text).unwrap();
    let density = grid(&volume, "density");
    assert_holds(
        density,
        (0..3).map(|x| (IVec3::new(x, 0, 0), (x + 1) as f32)),
    );
    let error = read(folder.path(), "density.txt", format!("2 1 1\n1 {zeros}x\n"));
    let error = told(error);
    assert!(error.contains("line 2: expected a number"), "{error}");
}

#[test]
fn a_header_after_a_block_of_white_space_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let blank = "\n".repeat(5 << 20);
    let volume = read(folder.path(), "density.txt", format!("{blank}1 1 1\n7"));
    assert_eq!(grid(&volume.unwrap(), "density").value(IVec3::ZERO), 7.0);
    let error = read(folder.path(), "density.txt", format!("{blank}1 1 1\nx"));
    let line = (5 << 20) + 2;
    let error = told(error);
    assert!(error.contains(&format!("line {line}: ")), "{error}");
}

/// Records of every voxel of the box, each later again with its right value; all of a length that no block is a multiple
/// of.
fn records() -> Vec<(IVec3, f32)> {
    let half = DIMS / 2;
    let wrong = voxels(IVec3::ZERO, half).map(|voxel| (voxel, -1.0));
    let right = voxels(IVec3::ZERO, half).map(|voxel| (voxel, value_at(voxel)));
    wrong.chain(right).collect()
}

fn sparse_text(records: &[(IVec3, f32)]) -> String {
    let mut text = format!("{} {} {} {} 0\n", DIMS.x, DIMS.y, DIMS.z, records.len());
    for (i, (voxel, value)) in records.iter().enumerate() {
        let part = ["\n", "\r\n", " "][i % 3];
        write!(text, "{} {}\n{} {value}{part}", voxel.x, voxel.y, voxel.z).unwrap();
    }
    text
}

#[test]
fn records_of_a_long_sparse_text_may_lie_across_any_border() {
    let folder = tempfile::tempdir().unwrap();
    let records = [records(), records(), records()].concat();
    let volume = read(folder.path(), "density.txt", sparse_text(&records)).unwrap();
    let half = voxels(IVec3::ZERO, DIMS / 2);
    let count = (DIMS / 2).element_product() as usize;
    let density = grid(&volume, "density");
    assert_eq!(density.active_voxels(), count as u64);
    assert_holds(density, half.map(|voxel| (voxel, value_at(voxel))));
    let again = format!("{} voxels came more than once", 5 * count);
    assert!(
        volume.notes.iter().any(|note| note.contains(&again)),
        "{:?}",
        volume.notes
    );
}

#[test]
fn faults_of_a_long_sparse_text_are_told_with_their_lines() {
    let folder = tempfile::tempdir().unwrap();
    let records = [records(), records(), records()].concat();
    let text = sparse_text(&records);
    let told = |text: &str| told(read(folder.path(), "density.txt", text));
    for share in [0.001, 0.3, 0.5, 0.999] {
        // A coordinate begins a line.
        let begin = (text.len() as f64 * share) as usize;
        let breaks = text[begin..].find('\n').unwrap() + begin + 1;
        let mut wrong = text.clone();
        wrong.insert(breaks, 'x');
        let line = 1 + lines_of(&wrong[..breaks]);
        let error = told(&wrong);
        assert!(error.contains(&format!("line {line}: ")), "{line}: {error}");
    }
    let cut = text.trim_end().rsplit_once(' ').unwrap().0;
    assert!(told(cut).contains("ends within a voxel"));
    assert!(told(&format!("{text} 1 1 1 1 x")).contains("found more"));
    let fewer = text.replacen(" 0\n", "0 0\n", 1);
    assert!(told(&fewer).contains("bytes follow"));
}

#[test]
fn a_long_sparse_binary_file_gives_every_record_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let records = records();
    let mut bytes = (records.len() as i32).to_le_bytes().to_vec();
    for (voxel, value) in &records {
        bytes.extend(
            (*voxel - 20)
                .to_array()
                .iter()
                .flat_map(|c| c.to_le_bytes()),
        );
        bytes.extend([f64::from(*value); 4].iter().flat_map(|c| c.to_le_bytes()));
    }
    let volume = read(folder.path(), "density.bin", &bytes).unwrap();
    let half = voxels(IVec3::ZERO, DIMS / 2);
    assert_holds(
        grid(&volume, "density"),
        half.map(|voxel| (voxel - 20, value_at(voxel))),
    );
    for index in [1, 100_000, records.len() - 1] {
        let mut wrong = bytes.clone();
        for index in [index, records.len() - 1] {
            wrong[4 + 44 * index..][..4].copy_from_slice(&i32::MAX.to_le_bytes());
        }
        let error = told(read(folder.path(), "density.bin", wrong));
        assert!(error.contains(&format!("record {index}: ")), "{error}");
    }
}

#[test]
fn a_sparse_file_of_too_many_bricks_is_refused_with_their_number() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "80 80 80 1000 0\n".to_owned();
    for voxel in voxels(IVec3::ZERO, IVec3::splat(10)) {
        writeln!(text, "{} {} {} 1", 8 * voxel.x, 8 * voxel.y, 8 * voxel.z).unwrap();
    }
    let path = write(folder.path(), "density.txt", &text);
    let limits = Limits {
        max_bytes: 100 * 2048,
        ..Limits::default()
    };
    let error = open(&[path], &limits).unwrap_err();
    let VolumeError::TooLarge { needed, limit, .. } = error else {
        panic!("{error}");
    };
    assert_eq!([needed, limit], [1000 * 2048, 100 * 2048]);
}
