//! Scene files, glTF and OBJ in; PNG, EXR and HDR pictures in and out.
