//! The process that holds a lock.

use std::fs::File;

/// The process that holds a lock on a file, if the system lists locks.
#[cfg(target_os = "linux")]
pub(super) fn lock_holder(file: &File) -> Option<u32> {
    use std::os::unix::fs::MetadataExt;
    let inode = file.metadata().ok()?.ino();
    of_inode(&std::fs::read_to_string("/proc/locks").ok()?, inode)
}

#[cfg(not(target_os = "linux"))]
pub(super) fn lock_holder(_: &File) -> Option<u32> {
    None
}

/// Finds a whole-file lock in the lines of `/proc/locks` (proc(5)): number, kind, mode, access, process, device and inode, ...
#[cfg(target_os = "linux")]
fn of_inode(locks: &str, inode: u64) -> Option<u32> {
    let process = |line: &str| {
        let mut words = line.split_whitespace().skip(1);
        let kind = words.next()?;
        let (process, place) = (words.nth(2)?, words.next()?);
        let found = place.rsplit(':').next()?.parse::<u64>().ok()?;
        (kind == "FLOCK" && found == inode).then(|| process.parse().ok())?
    };
    locks.lines().find_map(process)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_process_stands_before_the_inode() {
        let locks = "1: POSIX  ADVISORY  WRITE 7 fd:01:42 0 EOF\n2: FLOCK  ADVISORY  WRITE 812 fd:01:42 0 EOF\n\
                     3: FLOCK  ADVISORY  WRITE 9 fd:01:43 0 EOF\n";
        assert_eq!(of_inode(locks, 42), Some(812));
        assert_eq!(of_inode(locks, 44), None);
    }
}
