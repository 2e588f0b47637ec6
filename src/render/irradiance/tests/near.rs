//! Inside and beside the fire.
