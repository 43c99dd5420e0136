/* SIMD arithmetic: vectors of several floats (`Lanes`), and functions on them with the same names
 * for all instruction sets. The kernels of the renderer are written once with them.
 *
 * The Makefile compiles each *kernels.c three times. LANES_AVX512 gives 16 lanes and LANES_AVX2
 * gives 8 lanes; both use fused multiply-adds, and may be called only if kernels_usable()
 * [tilekernels.h] states that the processor supports them. Otherwise (LANES_PORTABLE) there are 4
 * lanes of plain IEEE arithmetic, which every processor supports. LANES_NAME(name) gives each of
 * the three compiled versions its own name.
 *
 * Only correctly rounded operations are used, and no approximate reciprocals. The results of one
 * version are therefore the same on every processor.
 *
 * Memory that is loaded or stored needs no alignment. If an argument of a minimum or maximum is
 * NaN, the result is not specified. Functions without a comment do in each lane what the C function
 * of the same name does. */
#ifndef CORCAST_RENDER_TILE_LANES_H
#define CORCAST_RENDER_TILE_LANES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#if defined LANES_AVX512
#include <immintrin.h>
#define LANES 16
#define LANES_NAME(name) name##_avx512
/* WIDE(operation): the intrinsic function of an operation. WideFloats: the vectors that it uses. */
#define WIDE(operation) _mm512_##operation
typedef __m512 WideFloats;
#define LANE_TARGET __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,fma")))
#elif defined LANES_AVX2
#include <immintrin.h>
#define LANES 8
#define LANES_NAME(name) name##_avx2
#define WIDE(operation) _mm256_##operation
typedef __m256 WideFloats;
#define LANE_TARGET __attribute__((target("avx2,fma")))
#else
#define LANES 4
#define LANES_NAME(name) name##_portable
#define LANES_PORTABLE
#define LANE_TARGET
#endif
#define LANE_FN LANE_TARGET static inline

/* LANES floats. */
typedef float Lanes __attribute__((vector_size(4 * LANES)));
/* LANES truth values: -1 (true) or 0 (false). The type also serves for LANES integers: the index
 * and the result of lanes_gather, the result of lanes_load_bytes. */
typedef int32_t LaneMask __attribute__((vector_size(4 * LANES)));
/* LANES unsigned integers. */
typedef uint32_t LaneWords __attribute__((vector_size(4 * LANES)));

/* Returns `value` in all lanes. */
LANE_FN Lanes lanes_set(float value)
{
    return (Lanes){0} + value;
}

/* Returns values[0 .. LANES). */
LANE_FN Lanes lanes_load(const float *values)
{
    Lanes lanes;
    __builtin_memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

/* Sets values[0 .. LANES). */
LANE_FN void lanes_store(float *values, Lanes lanes)
{
    __builtin_memcpy(values, &lanes, sizeof lanes);
}

#if LANES > 4

/* Returns a b + c. */
LANE_FN Lanes lanes_fma(Lanes a, Lanes b, Lanes c)
{
    return (Lanes)WIDE(fmadd_ps)((WideFloats)a, (WideFloats)b, (WideFloats)c);
}

LANE_FN Lanes lanes_sqrt(Lanes a)
{
    return (Lanes)WIDE(sqrt_ps)((WideFloats)a);
}

LANE_FN Lanes lanes_min(Lanes a, Lanes b)
{
    return (Lanes)WIDE(min_ps)((WideFloats)a, (WideFloats)b);
}

LANE_FN Lanes lanes_max(Lanes a, Lanes b)
{
    return (Lanes)WIDE(max_ps)((WideFloats)a, (WideFloats)b);
}

#endif

#if defined LANES_AVX512

/* Returns the mask as bits: bit i is set if lane i is true. */
LANE_FN uint32_t lanes_bits(LaneMask mask)
{
    return _mm512_movepi32_mask((__m512i)mask);
}

/* Returns true if any lane is true. */
LANE_FN bool lanes_any(LaneMask mask)
{
    return lanes_bits(mask) != 0;
}

/* Returns a in lanes where the mask is true, and b in the others. */
LANE_FN Lanes lanes_select(LaneMask mask, Lanes a, Lanes b)
{
    return (Lanes)_mm512_mask_blend_ps((__mmask16)lanes_bits(mask), (__m512)b, (__m512)a);
}

/* Returns the minimum of all lanes. */
LANE_FN float lanes_reduce_min(Lanes a)
{
    return _mm512_reduce_min_ps((__m512)a);
}

/* Returns table[index] for each lane. */
LANE_FN LaneMask lanes_gather(const uint32_t *table, LaneMask index)
{
    return (LaneMask)_mm512_i32gather_epi32((__m512i)index, table, 4);
}

/* Converts LANES bytes to integers, one per lane. An intrinsic is used because compilers translate
 * the portable form to one move per byte. */
LANE_FN LaneMask lanes_load_bytes(const uint8_t *bytes)
{
    return (LaneMask)_mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i *)bytes));
}

#elif defined LANES_AVX2

/* Returns a in lanes where the mask is true, and b in the others. */
LANE_FN Lanes lanes_select(LaneMask mask, Lanes a, Lanes b)
{
    return (Lanes)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)mask);
}

/* Returns the minimum of all lanes. */
LANE_FN float lanes_reduce_min(Lanes a)
{
    __m128 low = _mm256_castps256_ps128((__m256)a), high = _mm256_extractf128_ps((__m256)a, 1);
    __m128 least = _mm_min_ps(low, high);
    least = _mm_min_ps(least, _mm_movehl_ps(least, least));
    return _mm_cvtss_f32(_mm_min_ss(least, _mm_shuffle_ps(least, least, 1)));
}

/* Returns table[index] for each lane. */
LANE_FN LaneMask lanes_gather(const uint32_t *table, LaneMask index)
{
    return (LaneMask)_mm256_i32gather_epi32((const int *)table, (__m256i)index, 4);
}

/* Converts LANES bytes to integers, one per lane. */
LANE_FN LaneMask lanes_load_bytes(const uint8_t *bytes)
{
    return (LaneMask)_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)bytes));
}

/* Returns the mask as bits: bit i is set if lane i is true. */
LANE_FN uint32_t lanes_bits(LaneMask mask)
{
    return (uint32_t)_mm256_movemask_ps((__m256)mask);
}

/* Returns true if any lane is true. */
LANE_FN bool lanes_any(LaneMask mask)
{
    return lanes_bits(mask) != 0;
}

#else

/* Returns a b + c. */
LANE_FN Lanes lanes_fma(Lanes a, Lanes b, Lanes c)
{
    return a * b + c;
}

LANE_FN Lanes lanes_sqrt(Lanes a)
{
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
}

/* Returns a in lanes where the mask is true, and b in the others. */
LANE_FN Lanes lanes_select(LaneMask mask, Lanes a, Lanes b)
{
    return (Lanes)((mask & (LaneMask)a) | (~mask & (LaneMask)b));
}

LANE_FN Lanes lanes_min(Lanes a, Lanes b)
{
    return lanes_select(a < b, a, b);
}

LANE_FN Lanes lanes_max(Lanes a, Lanes b)
{
    return lanes_select(a > b, a, b);
}

/* Returns the minimum of all lanes. */
LANE_FN float lanes_reduce_min(Lanes a)
{
    float least = a[0];
    for (int i = 1; i < LANES; i++)
        least = a[i] < least ? a[i] : least;
    return least;
}

/* Returns table[index] for each lane. */
LANE_FN LaneMask lanes_gather(const uint32_t *table, LaneMask index)
{
    for (int i = 0; i < LANES; i++)
        index[i] = (int32_t)table[index[i]];
    return index;
}

/* Converts LANES bytes to integers, one per lane. */
LANE_FN LaneMask lanes_load_bytes(const uint8_t *bytes)
{
    return (LaneMask){bytes[0], bytes[1], bytes[2], bytes[3]};
}

/* Returns the mask as bits: bit i is set if lane i is true. */
LANE_FN uint32_t lanes_bits(LaneMask mask)
{
    return (uint32_t)((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
}

/* Returns true if any lane is true. */
LANE_FN bool lanes_any(LaneMask mask)
{
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

#endif

/* Adds `offset` to LANES doubles, in double precision, and rounds the sums to float. */
LANE_FN Lanes lanes_from_doubles_plus(const double *values, double offset)
{
    enum { HALF = LANES / 2 };
    typedef double Doubles __attribute__((vector_size(8 * HALF)));
    typedef float Floats __attribute__((vector_size(4 * HALF)));
    Floats halves[2];
    for (int half = 0; half < 2; half++) {
        Doubles wide;
        __builtin_memcpy(&wide, values + half * HALF, sizeof wide);
        halves[half] = __builtin_convertvector(wide + offset, Floats);
    }
    Lanes lanes;
    __builtin_memcpy(&lanes, halves, sizeof lanes);
    return lanes;
}

/* Adds `offset` to each lane, in double precision, and stores the sums. */
LANE_FN void lanes_to_doubles_plus(double *to, Lanes lanes, double offset)
{
    enum { HALF = LANES / 2 };
    typedef double Doubles __attribute__((vector_size(8 * HALF)));
    typedef float Floats __attribute__((vector_size(4 * HALF)));
    Floats halves[2];
    __builtin_memcpy(halves, &lanes, sizeof lanes);
    for (int half = 0; half < 2; half++) {
        Doubles wide = __builtin_convertvector(halves[half], Doubles) + offset;
        __builtin_memcpy(to + half * HALF, &wide, sizeof wide);
    }
}

typedef uint8_t LaneBytes __attribute__((vector_size(LANES)));

/* Stores a mask as bytes: 1 for true, 0 for false. */
LANE_FN void lanes_to_bytes(uint8_t *bytes, LaneMask mask)
{
    LaneBytes lanes = __builtin_convertvector(mask & 1, LaneBytes);
    __builtin_memcpy(bytes, &lanes, sizeof lanes);
}

/* Returns a mask of the bytes that are not 0. */
LANE_FN LaneMask lanes_of_bytes(const uint8_t *bytes)
{
    return lanes_load_bytes(bytes) != 0;
}

/* Returns a + b in lanes where the mask is true, and a in the others. */
LANE_FN Lanes lanes_add_where(LaneMask mask, Lanes a, Lanes b)
{
#if defined LANES_AVX512
    __mmask16 where = (__mmask16)lanes_bits(mask);
    return (Lanes)_mm512_mask_add_ps((__m512)a, where, (__m512)a, (__m512)b);
#else
    return a + lanes_select(mask, b, lanes_set(0));
#endif
}

/* Returns the minimum of a and b in lanes where the mask is true, and a in the others. */
LANE_FN Lanes lanes_min_where(LaneMask mask, Lanes a, Lanes b)
{
#if defined LANES_AVX512
    __mmask16 where = (__mmask16)lanes_bits(mask);
    return (Lanes)_mm512_mask_min_ps((__m512)a, where, (__m512)a, (__m512)b);
#else
    return lanes_min(a, lanes_select(mask, b, a));
#endif
}

LANE_FN Lanes lanes_abs(Lanes a)
{
    return (Lanes)((LaneMask)a & 0x7fffffff);
}

/* Returns the maximum of all lanes. */
LANE_FN float lanes_reduce_max(Lanes a)
{
    return -lanes_reduce_min(-a);
}

/* Returns exp(-x) for x >= 0. Returns 0 for x >= 24: the product of up to three results is then
 * never subnormal, and subnormal numbers are slow. x < 0 and NaN are not allowed.
 *
 * Computed as 2^n 2^f with f in [-1/2, 1/2]; 2^f is a polynomial with a relative error of 7.5e-8
 * (Remez). With rounding, the relative error is at most 2.5e-7 (1 + x). Adding `magic`, 1.5 * 2^23,
 * to a float rounds it to an integer, which is then in the low bits of the sum. */
LANE_FN Lanes lanes_exp_minus(Lanes x)
{
    const Lanes magic = lanes_set(12582912.0f), per_ln2 = lanes_set(-1.44269504f);
    Lanes shifted = lanes_fma(x, per_ln2, magic), n = shifted - magic;
    Lanes f = lanes_fma(x, per_ln2, -n);
    Lanes p = lanes_fma(f, lanes_set(0.00132764725f), lanes_set(0.00967554096f));
    p = lanes_fma(p, f, lanes_set(0.0555071309f));
    p = lanes_fma(p, f, lanes_set(0.240221202f));
    p = lanes_fma(p, f, lanes_set(0.693146944f));
    p = lanes_fma(p, f, lanes_set(1.00000012f));
#if defined LANES_AVX512
    return (Lanes)_mm512_maskz_scalef_ps((__mmask16)lanes_bits(x < 24.0f), (__m512)p, (__m512)n);
#else
    return (Lanes)(((LaneWords)p + ((LaneWords)shifted << 23)) & (LaneWords)(x < 24.0f));
#endif
}

/* Returns ln x for x > 0 that is not subnormal, with an error below 1e-7 (1 + |ln x|). For x near
 * 1, the relative error is below about 1e-7. Computed with x = 2^n m, m in [sqrt 1/2, sqrt 2), and
 * ln m = 2 artanh((m - 1) / (m + 1)). 0x3f3504f3 is the float sqrt 1/2. The last coefficient of the
 * series, 2/9, is changed to 0.23 to include the terms after it. */
LANE_FN Lanes lanes_log(Lanes x)
{
    LaneMask bits = (LaneMask)x - 0x3f3504f3;
    Lanes n = __builtin_convertvector(bits >> 23, Lanes);
    Lanes m = (Lanes)((bits & 0x007fffff) + 0x3f3504f3);
    Lanes f = (m - 1.0f) / (m + 1.0f), f2 = f * f;
    Lanes p = lanes_fma(f2, lanes_set(0.23f), lanes_set(0.285714286f));
    p = lanes_fma(p, f2, lanes_set(0.4f));
    p = lanes_fma(p, f2, lanes_set(0.666666667f));
    Lanes ln_m = lanes_fma(p * f2, f, f + f);
    return lanes_fma(n, lanes_set(0.693147181f), ln_m);
}

/* Returns erf x with an error below 3e-7, where `gauss` must be exp(-x^2). Source: Abramowitz &
 * Stegun 7.1.26, |error| <= 1.5e-7. */
LANE_FN Lanes lanes_erf(Lanes x, Lanes gauss)
{
    Lanes t = 1.0f / lanes_fma(lanes_abs(x), lanes_set(0.3275911f), lanes_set(1.0f));
    Lanes p = lanes_fma(t, lanes_set(1.061405429f), lanes_set(-1.453152027f));
    p = lanes_fma(p, t, lanes_set(1.421413741f));
    p = lanes_fma(p, t, lanes_set(-0.284496736f));
    p = lanes_fma(p, t, lanes_set(0.254829592f));
    Lanes magnitude = 1.0f - p * t * gauss;
    return (Lanes)((LaneMask)magnitude | ((LaneMask)x & INT32_MIN));
}

#endif
