//! Scenes of soft tissue in TOML: read, check, plan, build
