//! Views as hosts have them: any projection, a part of a buffer, a layer, several samples a pixel,
//! depth stored in another way, half the size, targets of other formats. Each is compared with the
//! ray tracer. These tests need a graphics adapter, a software one will do.

mod buffers;
mod cases;
mod host;
mod projections;
mod stereo;
mod targets;
