// Vectors of LANES flights, in the vector extension of GCC and Clang, and the functions that programs are written with.
// Vector functions of mathematics are the C library's where it has them (glibc's libmvec), else its scalar ones.
#include <math.h>
#include <string.h>
#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

typedef double vd __attribute__((vector_size(8 * LANES)));
typedef long long vl __attribute__((vector_size(8 * LANES)));
#define INLINE static inline __attribute__((always_inline, unused))

INLINE vd K(double x) { return x - (vd){}; }
INLINE vl M(bool x) { return x ? ~(vl){} : (vl){}; }

INLINE bool none(vl a) {
#if defined(__AVX512F__) && LANES == 8
  return _mm512_test_epi64_mask((__m512i)a, (__m512i)a) == 0;
#elif defined(__AVX2__) && LANES == 4
  return _mm256_testz_si256((__m256i)a, (__m256i)a);
#else
  long long any = 0;
  for (int i = 0; i < LANES; i++) any |= a[i];
  return any == 0;
#endif
}

// One where a mask is true, another elsewhere.
INLINE vd choose(vl mask, vd yes, vd no) { return mask ? yes : no; }
INLINE vl choose(vl mask, vl yes, vl no) { return (mask & yes) | (~mask & no); }
INLINE double choose(bool mask, double yes, double no) { return mask ? yes : no; }
INLINE bool choose(bool mask, bool yes, bool no) { return mask ? yes : no; }
INLINE vl invert(vl a) { return ~a; }
INLINE bool invert(bool a) { return !a; }

// Extremes are NaN where either argument is.
INLINE vd Vmax(vd x, vd y) { return ((x > y) | (x != x)) ? x : y; }
INLINE vd Vmin(vd x, vd y) { return ((x < y) | (x != x)) ? x : y; }
INLINE double Vmax(double x, double y) { return (x > y) | (x != x) ? x : y; }
INLINE double Vmin(double x, double y) { return (x < y) | (x != x) ? x : y; }

#define BY_LANE(name, call) \
  INLINE vd V##name(vd x) { vd r; for (int i = 0; i < LANES; i++) r[i] = call(x[i]); return r; }
#define BY_LANE2(name, call) \
  INLINE vd V##name(vd x, vd y) { vd r; for (int i = 0; i < LANES; i++) r[i] = call(x[i], y[i]); return r; }
#define PLAIN(name, call) INLINE double V##name(double x) { return call(x); }
#define PLAIN2(name, call) INLINE double V##name(double x, double y) { return call(x, y); }

#if defined(__AVX512F__) && LANES == 8
INLINE vd Vsqrt(vd x) { return (vd)_mm512_sqrt_pd((__m512d)x); }
INLINE vd Vabs(vd x) { return (vd)_mm512_abs_pd((__m512d)x); }
INLINE vd Vfloor(vd x) { return (vd)_mm512_roundscale_pd((__m512d)x, 9); }
INLINE vd Vceil(vd x) { return (vd)_mm512_roundscale_pd((__m512d)x, 10); }
INLINE vd Vtrunc(vd x) { return (vd)_mm512_roundscale_pd((__m512d)x, 11); }
#elif defined(__AVX2__) && LANES == 4
INLINE vd Vsqrt(vd x) { return (vd)_mm256_sqrt_pd((__m256d)x); }
INLINE vd Vabs(vd x) { return (vd)_mm256_andnot_pd(_mm256_set1_pd(-0.0), (__m256d)x); }
INLINE vd Vfloor(vd x) { return (vd)_mm256_round_pd((__m256d)x, 9); }
INLINE vd Vceil(vd x) { return (vd)_mm256_round_pd((__m256d)x, 10); }
INLINE vd Vtrunc(vd x) { return (vd)_mm256_round_pd((__m256d)x, 11); }
#else
BY_LANE(sqrt, sqrt) BY_LANE(abs, fabs) BY_LANE(floor, floor) BY_LANE(ceil, ceil) BY_LANE(trunc, trunc)
#endif
PLAIN(sqrt, sqrt) PLAIN(abs, fabs) PLAIN(floor, floor) PLAIN(ceil, ceil) PLAIN(trunc, trunc)

#define COMMON(X) X(sin) X(cos) X(exp) X(log)
#define MORE(X) X(tan) X(expm1) X(log1p) X(tanh) X(sinh) X(cosh) X(asin) X(acos) X(atan) X(asinh) X(acosh) X(atanh) X(erf)
#define SAME_PLAIN(name) PLAIN(name, name)
#define SAME_BY_LANE(name) BY_LANE(name, name)
COMMON(SAME_PLAIN) MORE(SAME_PLAIN) PLAIN2(atan2, atan2) PLAIN2(pow, pow) PLAIN2(fmod, fmod)

#ifdef LIBMVEC
#if defined(__AVX512F__) && LANES == 8
#define MVEC(name) _ZGVeN8v_##name
#define MVEC2(name) _ZGVeN8vv_##name
#else
#define MVEC(name) _ZGVdN4v_##name
#define MVEC2(name) _ZGVdN4vv_##name
#endif
#define FROM_LIBMVEC(name) extern "C" vd MVEC(name)(vd); INLINE vd V##name(vd x) { return MVEC(name)(x); }
#define FROM_LIBMVEC2(name) extern "C" vd MVEC2(name)(vd, vd); INLINE vd V##name(vd x, vd y) { return MVEC2(name)(x, y); }
COMMON(FROM_LIBMVEC) FROM_LIBMVEC2(pow)
#else
COMMON(SAME_BY_LANE) BY_LANE2(pow, pow)
#endif
#if defined(LIBMVEC) && LIBMVEC >= 235
MORE(FROM_LIBMVEC) FROM_LIBMVEC2(atan2)
#else
MORE(SAME_BY_LANE) BY_LANE2(atan2, atan2)
#endif

// Remainder with the sign of x: exact where x/y is below 2^52, else from the C library.
INLINE vd Vfmod(vd x, vd y) {
  const vd size = Vabs(x), unit = Vabs(y), q = Vtrunc(size / unit);
  vd r;
  if (none(~(q < 4503599627370496.0))) {
    for (int i = 0; i < LANES; i++) r[i] = fma(-q[i], unit[i], size[i]);
    r = r < 0.0 ? r + unit : r;
    r = r >= unit ? r - unit : r;
    return x < 0.0 ? -r : r;
  }
  for (int i = 0; i < LANES; i++) r[i] = fmod(x[i], y[i]);
  return r;
}

// Inputs: rows of flights, numbers that all share, and tables that are read at a place.
typedef vd vd_anywhere __attribute__((aligned(8)));
#define OWN(row) (*(const vd_anywhere*)(own + (row) * flights + first))
#define SHARED(place) shared[place]
#define STORE(row, value) (*(vd_anywhere*)(results + (row) * flights + first) = value)
INLINE double at(const double* table, double place) { return table[(long)place]; }
INLINE vd at(const double* table, vd place) {
  vd r;
  for (int i = 0; i < LANES; i++) r[i] = table[(long)place[i]];
  return r;
}
INLINE vd at_own(const double* table, vd place, long flights, long first) {
  vd r;
  for (int i = 0; i < LANES; i++) r[i] = table[(long)place[i] * flights + first + i];
  return r;
}
#define AT(table, place) at(tables[table], place)
#define AT_OWN(table, place) at_own(tables[table], place, flights, first)
