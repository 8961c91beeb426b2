//! Journal of a sweep on disk: if the program is killed, only the current block is lost.
//!
//! A journal has a header that identifies the sweep, then blocks, each with its length and a checksum. An incomplete
//! block of a killed program fails this check and is cut off when the journal is opened again.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use hardpoint_study::StudyCost;
use hardpoint_study::sweep;

/// First bytes of a journal, with the version of the format.
const HEAD: &[u8; 16] = b"hardpoint sweep1";
/// Size of a block header: length and checksum.
const FRAME: u64 = 16;
/// Numbers before the metrics of a block: first number, designs, motions, steps, metrics.
const OPENING: u64 = 40;

/// Identity of the sweep of a journal.
pub type Fingerprint = u128;

/// A journal, open for reading and appending.
pub struct Journal {
    file: File,
    path: Option<PathBuf>,
    /// Start of each block and its number of designs.
    blocks: Vec<(u64, usize)>,
    end: u64,
}

/// Reason why a journal cannot be resumed.
pub enum JournalError {
    /// The journal belongs to another sweep.
    Other,
    /// Another program is writing the journal.
    Busy,
    /// The journal cannot be read or written.
    Failed(io::Error),
}

impl From<io::Error> for JournalError {
    fn from(error: io::Error) -> Self {
        Self::Failed(error)
    }
}

impl Journal {
    /// Creates the journal of a sweep, or opens it with all complete blocks; `anew` discards an existing one. Without a
    /// path the journal is an anonymous file.
    pub fn open(path: Option<&Path>, fingerprint: Fingerprint, anew: bool) -> Result<Self, JournalError> {
        let Some(path) = path else {
            let mut journal = Self { file: tempfile::tempfile()?, path: None, blocks: Vec::new(), end: 0 };
            journal.begin(fingerprint)?;
            return Ok(journal);
        };
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(JournalError::Busy),
            // On file systems without locks, other programs are not excluded.
            Err(TryLockError::Error(_)) | Ok(()) => {}
        }
        let mut journal = Self { file, path: Some(path.into()), blocks: Vec::new(), end: 0 };
        let mut head = Vec::new();
        (&journal.file).take((HEAD.len() + 16) as u64).read_to_end(&mut head)?;
        if anew || head.len() < HEAD.len() + 16 {
            journal.begin(fingerprint)?;
        } else if head[..HEAD.len()] != *HEAD || head[HEAD.len()..] != fingerprint.to_le_bytes() {
            return Err(JournalError::Other);
        } else {
            journal.find_blocks(head.len() as u64)?;
        }
        Ok(journal)
    }

    fn begin(&mut self, fingerprint: Fingerprint) -> io::Result<()> {
        self.file.set_len(0)?;
        self.file.seek(SeekFrom::Start(0))?;
        let mut head = HEAD.to_vec();
        head.extend(fingerprint.to_le_bytes());
        self.file.write_all(&head)?;
        self.end = head.len() as u64;
        Ok(())
    }

    /// Finds the complete, consecutive blocks and cuts off the rest.
    fn find_blocks(&mut self, first: u64) -> io::Result<()> {
        let length = self.file.metadata()?.len();
        let mut reader = BufReader::new(&self.file);
        let mut at = first;
        let mut payload = Vec::new();
        while at + FRAME <= length {
            let [size, sum] = [number(&mut reader)?, number(&mut reader)?];
            if size > length - at - FRAME {
                break;
            }
            payload.resize(size as usize, 0);
            reader.read_exact(&mut payload)?;
            if checksum(&payload) as u64 != sum {
                break;
            }
            let Some(block) = decoded(&payload).filter(|b| b.numbers.start == self.designs()) else { break };
            self.blocks.push((at, block.numbers.len()));
            at += FRAME + size;
        }
        self.end = at;
        self.file.set_len(at)?;
        self.file.seek(SeekFrom::Start(at)).map(drop)
    }

    /// Number of stored designs, counted from the first one.
    pub fn designs(&self) -> usize {
        self.blocks.iter().map(|(_, designs)| designs).sum()
    }

    /// Adds a block.
    pub fn add(&mut self, block: &sweep::Block) -> io::Result<()> {
        let payload = encoded(block);
        let mut bytes = Vec::with_capacity(FRAME as usize + payload.len());
        bytes.extend((payload.len() as u64).to_le_bytes());
        bytes.extend((checksum(&payload) as u64).to_le_bytes());
        bytes.extend(&payload);
        self.file.write_all(&bytes)?;
        self.blocks.push((self.end, block.numbers.len()));
        self.end += bytes.len() as u64;
        Ok(())
    }

    /// Passes all blocks in order to `see`.
    pub fn each(&self, mut see: impl FnMut(sweep::Block) -> io::Result<()>) -> io::Result<()> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(self.blocks.first().map_or(self.end, |(at, _)| *at)))?;
        let mut reader = BufReader::with_capacity(1 << 20, file);
        let mut payload = Vec::new();
        for _ in &self.blocks {
            let [size, _] = [number(&mut reader)?, number(&mut reader)?];
            payload.resize(size as usize, 0);
            reader.read_exact(&mut payload)?;
            see(decoded(&payload).ok_or_else(broken)?)?;
        }
        file.seek(SeekFrom::Start(self.end)).map(drop)
    }

    /// Values of one metric for all designs.
    pub fn column(&self, metric: usize) -> io::Result<Vec<f64>> {
        let mut file = &self.file;
        let mut found = Vec::with_capacity(self.designs());
        let mut bytes = Vec::new();
        for (at, designs) in &self.blocks {
            file.seek(SeekFrom::Start(at + FRAME + OPENING + 8 * (metric * designs) as u64))?;
            bytes.resize(8 * designs, 0);
            file.read_exact(&mut bytes)?;
            found.extend(
                bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))),
            );
        }
        file.seek(SeekFrom::Start(self.end))?;
        Ok(found)
    }

    /// Removes the journal of a finished sweep.
    pub fn remove(self) -> io::Result<()> {
        self.path.map_or(Ok(()), std::fs::remove_file)
    }
}

fn broken() -> io::Error {
    io::Error::other("the stored data have been changed meanwhile")
}

fn number(from: &mut impl Read) -> io::Result<u64> {
    let mut bytes = [0; 8];
    from.read_exact(&mut bytes)?;
    Ok(u64::from_le_bytes(bytes))
}

/// The 128 bits of Fowler, Noll and Vo's hash, FNV-1a.
pub fn checksum(bytes: &[u8]) -> u128 {
    let mut sum = Checksum::default();
    sum.add(bytes);
    sum.0
}

/// A writer that computes the checksum of its input.
pub struct Checksum(pub u128);

impl Default for Checksum {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Checksum {
    fn add(&mut self, bytes: &[u8]) {
        const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(*byte)).wrapping_mul(PRIME);
        }
    }
}

impl std::fmt::Write for Checksum {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.add(text.as_bytes());
        Ok(())
    }
}

fn encoded(block: &sweep::Block) -> Vec<u8> {
    let mut out = Vec::new();
    let count = |out: &mut Vec<u8>, n: usize| out.extend((n as u64).to_le_bytes());
    let floats = |out: &mut Vec<u8>, of: &[f64]| of.iter().for_each(|x| out.extend(x.to_le_bytes()));
    let text = |out: &mut Vec<u8>, of: &str| {
        count(out, of.len());
        out.extend(of.as_bytes());
    };
    let sweep::Block { numbers, metrics, curves, failures, cost } = block;
    for n in [numbers.start, numbers.len(), cost.motions, cost.steps, metrics.len()] {
        count(&mut out, n);
    }
    metrics.iter().for_each(|column| floats(&mut out, column));
    count(&mut out, failures.len());
    for sweep::Failure { number, motion, reason, why } in failures {
        count(&mut out, *number);
        count(&mut out, *motion);
        text(&mut out, reason);
        text(&mut out, why);
    }
    count(&mut out, curves.len());
    for sweep::Curves { steps, values } in curves {
        steps.iter().for_each(|n| count(&mut out, *n as usize));
        count(&mut out, values.len());
        floats(&mut out, values);
    }
    out
}

/// Decodes a block; `None` if it is invalid.
fn decoded(bytes: &[u8]) -> Option<sweep::Block> {
    let mut from = Decoder(bytes);
    let start = from.count()?;
    let [designs, motions, steps, metrics] = [from.count()?, from.count()?, from.count()?, from.count()?];
    let mut block = sweep::Block { numbers: start..start.checked_add(designs)?, ..sweep::Block::default() };
    block.cost = StudyCost { designs, motions, steps };
    for _ in 0..metrics {
        block.metrics.push(from.floats(designs)?);
    }
    for _ in 0..from.count()? {
        let [number, motion] = [from.count()?, from.count()?];
        block.failures.push(sweep::Failure { number, motion, reason: from.text()?, why: from.text()? });
    }
    for _ in 0..from.count()? {
        let steps = (0..designs).map(|_| from.count().map(|n| n as u32)).collect::<Option<_>>()?;
        let values = from.count()?;
        block.curves.push(sweep::Curves { steps, values: from.floats(values)? });
    }
    from.0.is_empty().then_some(block)
}

struct Decoder<'b>(&'b [u8]);

impl<'b> Decoder<'b> {
    fn take(&mut self, n: usize) -> Option<&'b [u8]> {
        let (taken, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(taken)
    }

    fn count(&mut self) -> Option<usize> {
        let bytes = self.take(8)?.try_into().ok()?;
        usize::try_from(u64::from_le_bytes(bytes)).ok()
    }

    fn floats(&mut self, n: usize) -> Option<Vec<f64>> {
        let bytes = self.take(n.checked_mul(8)?)?.chunks_exact(8);
        Some(bytes.map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect())
    }

    fn text(&mut self) -> Option<String> {
        let n = self.count()?;
        String::from_utf8(self.take(n)?.to_vec()).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(first: usize) -> sweep::Block {
        let failure = |number| sweep::Failure {
            number,
            motion: 1,
            reason: "locks".into(),
            why: "locks — würgt".into(),
        };
        sweep::Block {
            numbers: first..first + 3,
            metrics: vec![vec![first as f64, f64::MIN_POSITIVE, -0.0], vec![1e300, 0.1, f64::MAX]],
            curves: vec![sweep::Curves { steps: vec![2, 0, 1], values: vec![0.5; 6] }],
            failures: (first == 3).then(|| failure(4)).into_iter().collect(),
            cost: StudyCost { designs: 3, motions: 6, steps: 3 },
        }
    }

    fn opened(path: &Path) -> Journal {
        match Journal::open(Some(path), 7, false) {
            Ok(journal) => journal,
            Err(JournalError::Failed(e)) => panic!("{e}"),
            Err(_) => panic!("not ours"),
        }
    }

    fn blocks(journal: &Journal) -> Vec<sweep::Block> {
        let mut found = Vec::new();
        journal
            .each(|b| {
                found.push(b);
                Ok(())
            })
            .unwrap();
        found
    }

    #[test]
    fn wherever_a_journal_breaks_off_whole_blocks_are_kept_and_it_can_be_gone_on_with() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.partial");
        let mut journal = opened(&path);
        let all: Vec<sweep::Block> = [0, 3, 6].map(block).into();
        let mut ends = vec![journal.end];
        for b in &all {
            journal.add(b).unwrap();
            ends.push(journal.end);
        }
        drop(journal);
        let whole = std::fs::read(&path).unwrap();
        for length in 0..=whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            let mut journal = opened(&path);
            let kept = ends.iter().filter(|end| **end <= length as u64).count().saturating_sub(1);
            assert_eq!(blocks(&journal), all[..kept], "{length}");
            assert_eq!(journal.designs(), 3 * kept);
            all[kept..].iter().for_each(|b| journal.add(b).unwrap());
            assert_eq!(journal.column(1).unwrap(), [1e300, 0.1, f64::MAX].repeat(3));
            drop(journal);
            assert!(std::fs::read(&path).unwrap() == whole, "{length}");
        }
        // A flipped bit invalidates its block and all later ones.
        let mut spoilt = whole.clone();
        spoilt[ends[1] as usize + 40] ^= 1;
        std::fs::write(&path, spoilt).unwrap();
        assert_eq!(blocks(&opened(&path)), all[..1]);
    }

    #[test]
    fn a_journal_of_another_sweep_or_under_way_is_not_touched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.partial");
        let journal = opened(&path);
        assert!(matches!(Journal::open(Some(&path), 7, false), Err(JournalError::Busy)));
        drop(journal);
        let before = std::fs::read(&path).unwrap();
        assert!(matches!(Journal::open(Some(&path), 8, false), Err(JournalError::Other)));
        assert_eq!(std::fs::read(&path).unwrap(), before);
        assert!(Journal::open(Some(&path), 8, true).is_ok());
        std::fs::write(&path, "a note of forty letters, not a journal..").unwrap();
        assert!(matches!(Journal::open(Some(&path), 8, false), Err(JournalError::Other)));
    }
}
