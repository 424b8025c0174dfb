//! Soft-tissue dynamics that prints its error beside its speed: the face of the sinew crates
