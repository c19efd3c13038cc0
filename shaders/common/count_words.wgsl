// The words of InputCounts, for kernels that only read them: structures with atomics cannot be
// bound for reading.
const COUNT_MERGED: u32 = 0;
const COUNT_ROUNDED: u32 = 2;
