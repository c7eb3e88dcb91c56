// needs: instances
// Instances where casters are drawn.

@group(1) @binding(0) var<storage, read> instances: array<Instance>;
