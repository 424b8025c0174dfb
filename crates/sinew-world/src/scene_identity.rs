//! Identities of scenes.

/// Identity of a scene, from its text and the files that it reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SceneIdentity {
    /// SHA-256 in hexadecimal digits.
    pub(crate) sha256: String,
    pub(crate) key: SceneKey,
}

/// Some digits of the identity of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SceneKey(u64);

impl SceneIdentity {
    /// The identity of a hash.
    pub(crate) fn of(sha256: String) -> Self {
        let key = sha256.bytes().take(16).fold(0, |key, digit| {
            let digit = char::from(digit).to_digit(16).unwrap_or_default();
            key << 4 | u64::from(digit)
        });
        Self {
            sha256,
            key: SceneKey(key),
        }
    }
}
