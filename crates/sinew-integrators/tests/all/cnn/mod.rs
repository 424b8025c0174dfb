//! Cellular networks.

mod bit_identity;
mod energy;
mod rigid;
mod stabilised;
