//! The folder of a mesh in tiles, and what an unfinished run keeps in it.

use crate::failure::Failure;
use gdel::tiles::Message;
use gdel_io::files::{FileError, write_file};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

/// The name of the file that describes a mesh in tiles.
const INDEX: &str = "mesh.json";

/// What [`INDEX`] says.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Index {
    /// Tells the file from others.
    pub(super) gdel: String,
    /// The dimension of the space: 2 or 3.
    pub(super) dim: u8,
    /// The affine dimension of the points.
    pub(super) dimension: u8,
    pub(super) points: u64,
    pub(super) duplicates: u64,
    pub(super) simplices: u64,
    /// The file of each tile.
    pub(super) tiles: Vec<String>,
}

/// What [`Index::gdel`] is.
pub(super) const KIND: &str = "mesh in tiles";

/// The folder of a mesh.
pub(super) struct Folder {
    path: PathBuf,
    /// Held while the folder is written.
    _lock: Option<File>,
}

impl Folder {
    /// Opens the folder of a finished mesh.
    pub(super) fn open(path: &Path) -> Result<(Self, Index), Failure> {
        let folder = Folder { path: path.into(), _lock: None };
        match folder.read_json::<Index>(&folder.path.join(INDEX))? {
            Some(index) if index.gdel == KIND => Ok((folder, index)),
            _ => Err(folder.is_not(&format!("a mesh in tiles: it has no {INDEX}"))),
        }
    }

    /// Creates the folder, or takes one of an earlier run, of which what is finished is removed. A folder with anything
    /// else in it is taken with `force` only.
    pub(super) fn create(path: &Path, force: bool) -> Result<Self, Failure> {
        let mut folder = Folder { path: path.into(), _lock: None };
        let work = folder.work("");
        let known = work.exists() || folder.path.join(INDEX).exists();
        let is_empty = !path.exists() || fs::read_dir(path).map_err(read_error(path))?.next().is_none();
        if !known && !is_empty && !force {
            return Err(folder.is_not("empty, nor a mesh in tiles: add `--force` to write into it"));
        }
        fs::create_dir_all(&work).map_err(write_error(&work))?;
        let lock = folder.work("lock");
        let file = OpenOptions::new().create(true).truncate(false).write(true).open(&lock);
        let file = file.map_err(write_error(&lock))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(folder.is_not("free: another run is writing it")),
            // Where files have no locks, nobody else is looked for.
            Err(TryLockError::Error(_)) => {}
        }
        folder._lock = Some(file);
        // Whoever was killed has left its temporary files.
        folder.remove_where(|_, name| name.starts_with(".gdel-") && name.ends_with(".tmp"))?;
        Ok(folder)
    }

    fn is_not(&self, what: &str) -> Failure {
        Failure::Folder { path: self.path.clone(), what: format!("this folder is not {what}") }
    }

    /// Returns the path of a file of the finished mesh.
    pub(super) fn finished(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Returns the path of a file that an unfinished run keeps.
    pub(super) fn work(&self, name: &str) -> PathBuf {
        self.path.join("unfinished").join(name)
    }

    /// Removes what an unfinished run keeps, and what is finished.
    pub(super) fn clear(&self) -> Result<(), Failure> {
        self.remove_where(|is_work, name| match is_work {
            true => name != "lock",
            false => name.starts_with("tile-") || name.starts_with("mesh."),
        })
    }

    /// Removes files whose names are as told: of the folder, or, where the first argument is true, of the unfinished run.
    fn remove_where(&self, is_removed: impl Fn(bool, &str) -> bool) -> Result<(), Failure> {
        for (folder, is_work) in [(&self.path, false), (&self.work(""), true)] {
            for entry in fs::read_dir(folder).map_err(read_error(folder))? {
                let path = entry.map_err(read_error(folder))?.path();
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                if path.is_file() && is_removed(is_work, &name) {
                    remove(&path)?;
                }
            }
        }
        Ok(())
    }

    /// Ends the run: the mesh is complete.
    pub(super) fn finish(self, index: &Index) -> Result<(), Failure> {
        self.write_json(&self.finished(INDEX), index)?;
        let work = self.work("");
        drop(self._lock);
        fs::remove_dir_all(&work).map_err(|source| FileError::Write { path: work.clone(), source })?;
        Ok(())
    }

    /// Reads a file of an unfinished run.
    pub(super) fn read(&self, name: &str) -> Result<Vec<u8>, Failure> {
        let path = self.work(name);
        fs::read(&path).map_err(read_error(&path))
    }

    /// Writes a file of an unfinished run: whole, or not at all.
    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        Ok(write_file(&self.work(name), |to| to.write_all(bytes))?)
    }

    /// Creates the failure that a file of an unfinished run is damaged.
    pub(super) fn damaged(&self, name: &str, what: impl ToString) -> Failure {
        Failure::Damaged { path: self.work(name), folder: self.work(""), what: what.to_string() }
    }

    /// Reads a file in JSON, if it is there.
    pub(super) fn read_json<T: DeserializeOwned>(&self, path: &Path) -> Result<Option<T>, Failure> {
        match fs::read(path) {
            Ok(bytes) => Ok(serde_json::from_slice(&bytes).ok()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(read_error(path)(error)),
        }
    }

    /// Writes a file in JSON.
    pub(super) fn write_json(&self, path: &Path, content: &impl Serialize) -> Result<(), Failure> {
        Ok(write_file(path, |to| Ok(serde_json::to_writer_pretty(to, content)?))?)
    }

    /// Writes what a tile has sent in a step: whole, or not at all.
    pub(super) fn send<const D: usize>(&self, name: &str, sent: &[(u32, Message<D>)]) -> Result<(), Failure> {
        let messages: Vec<Vec<u8>> = sent.iter().map(|(_, message)| message.to_bytes()).collect();
        let path = self.work(name);
        let write = |to: &mut dyn Write| {
            to.write_all(&(messages.len() as u64).to_le_bytes())?;
            for ((receiver, message), bytes) in sent.iter().zip(&messages) {
                for word in [u64::from(*receiver), message.points() as u64, bytes.len() as u64] {
                    to.write_all(&word.to_le_bytes())?;
                }
            }
            messages.iter().try_for_each(|bytes| to.write_all(bytes))
        };
        Ok(write_file(&path, write)?)
    }

    /// Returns the places of the messages in a file that [`send`](Self::send) has written.
    pub(super) fn receivers(&self, name: &str) -> Result<Vec<Place>, Failure> {
        let path = self.work(name);
        let mut file = File::open(&path).map_err(read_error(&path))?;
        let size = file.metadata().map_err(read_error(&path))?.len();
        let mut word = || -> Result<u64, Failure> {
            let mut bytes = [0; 8];
            file.read_exact(&mut bytes).map_err(|error| self.damaged(name, error))?;
            Ok(u64::from_le_bytes(bytes))
        };
        let count = word()?;
        if count > size / 24 {
            return Err(self.damaged(name, "too short"));
        }
        let mut at = 8 + 24 * count;
        let mut all = Vec::new();
        for _ in 0..count {
            let (to, points, length) = (word()?, word()?, word()?);
            all.push(Place { to, points, at, length });
            at = at.saturating_add(length);
        }
        if at == size { Ok(all) } else { Err(self.damaged(name, "not as long as it says")) }
    }

    /// Reads one of the messages of a file.
    pub(super) fn receive<const D: usize>(&self, name: &str, place: Place) -> Result<Message<D>, Failure> {
        let path = self.work(name);
        let read = || -> io::Result<Vec<u8>> {
            let mut file = File::open(&path)?;
            file.seek(SeekFrom::Start(place.at))?;
            let mut bytes = vec![0; place.length as usize];
            file.read_exact(&mut bytes)?;
            Ok(bytes)
        };
        Message::from_bytes(&read().map_err(read_error(&path))?).map_err(|error| self.damaged(name, error))
    }
}

/// The place of a message in a file.
pub(super) struct Place {
    /// The tile that it is for.
    pub(super) to: u64,
    /// The number of points in it.
    pub(super) points: u64,
    /// Where it begins, in bytes.
    at: u64,
    /// In bytes.
    length: u64,
}

/// Removes a file if it is there.
pub(super) fn remove(path: &Path) -> Result<(), Failure> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(write_error(path)(error)),
        _ => Ok(()),
    }
}

pub(super) fn read_error(path: &Path) -> impl Fn(io::Error) -> Failure {
    let path = path.to_owned();
    move |source| FileError::Read { path: path.clone(), source }.into()
}

pub(super) fn write_error(path: &Path) -> impl Fn(io::Error) -> Failure {
    let path = path.to_owned();
    move |source| FileError::Write { path: path.clone(), source }.into()
}
