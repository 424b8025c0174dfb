//! Time integrators for soft tissue: explicit, implicit and cellular neural network
