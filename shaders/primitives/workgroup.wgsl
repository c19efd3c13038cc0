// The invocations of a workgroup, in every kernel: the maximum that every WebGPU device supports.
const WORKGROUP: u32 = 256;
