// Integers of several limbs as floats with an exponent of their own: they neither overflow nor
// underflow.
//
// Expects: LIMBS, the limbs of an integer.

// value·2^exponent, where 1/2 ≤ |value| ≤ 1; or 0, with an exponent below all others.
struct Float {
    value: f32,
    exponent: i32,
}

const ZERO_EXPONENT: i32 = -10000;

// Returns an integer in two's complement. Its first 32 bits are converted, with one rounding.
fn float_of(limbs: array<u32, LIMBS>) -> Float {
    var integer = limbs;
    let negative = integer[LIMBS - 1] >> 31;
    let flipped = 0 - negative;
    // The magnitude's highest limb that is not 0, the one below it, and the number of the first.
    var high = 0u;
    var low = 0u;
    var top = 0u;
    var before = 0u;
    var carry = negative;
    for (var i = 0u; i < LIMBS; i++) {
        let limb = (integer[i] ^ flipped) + carry;
        carry &= u32(limb == 0);
        if limb != 0 {
            high = limb;
            low = before;
            top = i;
        }
        before = limb;
    }
    if high == 0 {
        return Float(0, ZERO_EXPONENT);
    }
    let zeros = countLeadingZeros(high);
    let leading = (high << zeros) | select(low >> (32 - max(zeros, 1)), 0u, zeros == 0);
    let value = f32(leading) * 0x1p-32;
    return Float(select(value, -value, negative != 0), i32(32 * (top + 1) - zeros));
}

// Returns the value times 2^(its exponent − exponent), for an exponent that is not lower; what is
// below 2^-100 becomes 0.
fn aligned(f: Float, exponent: i32) -> f32 {
    let by = f.exponent - exponent;
    let power = bitcast<f32>(u32(127 + max(by, -100)) << 23);
    return select(f.value * power, 0.0, by < -100);
}

// Returns the bits of x·2^by. Beyond the range of f32 they are those of infinity, below that of
// its normal numbers those of 0.
fn scaled_bits(x: f32, by: i32) -> u32 {
    let bits = bitcast<u32>(x);
    let biased = i32((bits >> 23) & 0xff);
    let scaled = biased + by;
    if biased == 0 || scaled <= 0 {
        return 0;
    }
    let sign = bits & 0x80000000;
    return select((bits & 0x807fffff) | (u32(scaled) << 23), sign | 0x7f800000, scaled >= 255);
}
