//! Real-time shadows on wgpu: every technique behind one interface.
