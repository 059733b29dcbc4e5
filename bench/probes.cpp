// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "probes.hpp"

#include <cmath>

namespace probes {
namespace {

#if defined(__AVX512F__)
constexpr int register_bytes = 64;
#elif defined(__AVX__)
constexpr int register_bytes = 32;
#else
constexpr int register_bytes = 16;
#endif

#define PROBE_INLINE [[gnu::always_inline]] inline

template <class Real>
struct PackOf {
  typedef Real Type __attribute__((vector_size(register_bytes)));
  typedef Real Unaligned __attribute__((vector_size(register_bytes), aligned(sizeof(Real))));
};
template <class Real>
using Pack = typename PackOf<Real>::Type;
template <class Real>
constexpr int lanes = register_bytes / static_cast<int>(sizeof(Real));

template <class Real>
PROBE_INLINE Pack<Real> load(Real const* from) {
  return *reinterpret_cast<typename PackOf<Real>::Unaligned const*>(from);
}
template <class Real>
PROBE_INLINE void store(Pack<Real> const& pack, Real* to) {
  *reinterpret_cast<typename PackOf<Real>::Unaligned*>(to) = pack;
}
PROBE_INLINE Pack<double> root(Pack<double> s) {
  for (int i = 0; i < lanes<double>; ++i) s[i] = std::sqrt(s[i]);
  return s;
}
PROBE_INLINE Pack<float> root(Pack<float> s) {
  for (int i = 0; i < lanes<float>; ++i) s[i] = std::sqrt(s[i]);
  return s;
}

template <class P>
struct Vector {
  P x, y, z;
};
template <class P>
PROBE_INLINE Vector<P> operator+(Vector<P> const& a, Vector<P> const& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class P>
PROBE_INLINE Vector<P> operator-(Vector<P> const& a, Vector<P> const& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class P, class S>
PROBE_INLINE Vector<P> operator*(S const& s, Vector<P> const& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class P>
PROBE_INLINE P dot(Vector<P> const& a, Vector<P> const& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class P>
PROBE_INLINE Vector<P> cross(Vector<P> const& a, Vector<P> const& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// cay(f) m
template <class Real, class P>
PROBE_INLINE Vector<P> cayley(Vector<P> const& f, Vector<P> const& m) {
  Vector<P> const c = cross(f, m);
  P const scale = Real(4) / (Real(4) + dot(f, f));
  return m + scale * (c + Real(0.5) * cross(f, c));
}
/// dcay_f^-1 y
template <class Real, class P>
PROBE_INLINE Vector<P> dcay_inverse(Vector<P> const& f, Vector<P> const& y) {
  return y + Real(-0.5) * cross(f, y) + (Real(0.25) * dot(f, y)) * f;
}
/// Returns the spin at the coordinates step * chart_rate(u, m, m0) of the stereographic chart at
/// m0.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_move(Real step, Vector<P> const& u, Vector<P> const& m,
                                  Vector<P> const& m0) {
  P const e2 = Real(2) * dot(m, m0) + Real(2);
  P const reach = step * dot(u, u);
  P const scale = (Real(4) * step) / (e2 * e2 + (Real(4) * step) * reach);
  P const along = Real(-2) * scale * dot(u, m0);
  return m0 + (along - Real(2) * scale * reach) * m0 + (scale * e2) * u + along * m;
}
/// Returns the coordinates of the spin w in the stereographic chart at m0.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_of(Vector<P> const& w, Vector<P> const& m0) {
  Vector<P> const d = w - m0;
  P const square = dot(d, d);
  return (Real(1) / (Real(4) - square)) * ((d + d) + square * m0);
}
/// Returns the spin with coordinates f in the chart at m0.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_to(Vector<P> const& f, Vector<P> const& m0) {
  P const s = dot(f, f);
  return m0 + (Real(2) / (Real(1) + s)) * (f - s * m0);
}
/// Returns the time derivative of the coordinates, in the chart at m0, of a spin m with m' = u.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_rate(Vector<P> const& u, Vector<P> const& m, Vector<P> const& m0) {
  P const inverse = Real(2) / (Real(2) * dot(m, m0) + Real(2));
  return inverse * (u - (inverse * dot(u, m0)) * (m + m0));
}

}  // namespace

template <class Real>
Probe<Real>::Probe(Scene const& scene)
    : scene_(scene), pitch_(scene.nx + 2 * margin), stride_(pitch_ * scene.ny * scene.nz + margin) {
  for (auto& field : fields_) field.assign(static_cast<std::size_t>(3 * stride_), Real(0));
}

template <class Real>
PROBE_INLINE auto Probe<Real>::read(int field, std::ptrdiff_t at) const {
  Real const* const from = fields_[field].data() + at;
  return Vector<Pack<Real>>{load(from), load(from + stride_), load(from + 2 * stride_)};
}
template <class Real>
template <class Vector>
PROBE_INLINE void Probe<Real>::write(Vector const& v, int field, std::ptrdiff_t at) {
  Real* const to = fields_[field].data() + at;
  store(v.x, to), store(v.y, to + stride_), store(v.z, to + 2 * stride_);
}

/// Calls body(at, m, A) for each pack of the spins in field `level`, where `at` is the index of its
/// first spin. Writes the ghost sites of field `out` after each row. Unless Whole, A leaves out the
/// part -6 * exchange * m, which does not rotate m.
template <class Real>
template <bool Whole, class Body>
PROBE_INLINE void Probe<Real>::for_each_pack(int level, int out, Body const& body) {
  auto const exchange = static_cast<Real>(scene_.exchange);
  auto const anisotropy = static_cast<Real>(scene_.anisotropy);
  auto const applied = static_cast<Real>(scene_.applied);
  auto const damping = static_cast<Real>(scene_.damping);
  Real const* const spins = fields_[level].data();
  std::ptrdiff_t const stride = stride_;
  auto const pairs = [&](Real const* from, std::ptrdiff_t const(&to)[4]) {
    return (load(from - 1) + load(from + 1)) + (load(from + to[0]) + load(from + to[1])) +
           (load(from + to[2]) + load(from + to[3]));
  };
  for (int z = 0; z < scene_.nz; ++z)
    for (int y = 0; y < scene_.ny; ++y) {
      std::ptrdiff_t const plane = pitch_ * scene_.ny;
      std::ptrdiff_t const to[4] = {y > 0 ? -pitch_ : 0, y + 1 < scene_.ny ? pitch_ : 0,
                                    z > 0 ? -plane : 0, z + 1 < scene_.nz ? plane : 0};
      std::ptrdiff_t const row = margin + (z * scene_.ny + y) * pitch_;
      for (std::ptrdiff_t at = row; at < row + scene_.nx; at += lanes<Real>) {
        Real const* const from = spins + at;
        Vector<Pack<Real>> const m{load(from), load(from + stride), load(from + 2 * stride)};
        Vector<Pack<Real>> h{pairs(from, to), pairs(from + stride, to),
                             pairs(from + 2 * stride, to)};
        if constexpr (Whole) h = h - Real(6) * m;
        h = exchange * h;
        h.z += anisotropy * m.z + applied;
        body(at, m, h + damping * cross(m, h));
      }
      for (int component = 0; component < 3; ++component) {
        Real* const begin = fields_[out].data() + component * stride + row;
        begin[-1] = begin[0];
        begin[scene_.nx] = begin[scene_.nx - 1];
      }
    }
}

// Calls work(index in (sites, 3), index in a field) for each component of each site and of the
// ghost sites at the ends of the rows, which have the spins of the sites beside them.
template <class Real>
template <class Work>
void Probe<Real>::for_each_site(Work const& work) const {
  for (int row = 0; row < scene_.ny * scene_.nz; ++row)
    for (int x = -1; x <= scene_.nx; ++x)
      for (int component = 0; component < 3; ++component) {
        int const inside = x < 0 ? 0 : x < scene_.nx ? x : scene_.nx - 1;
        work(static_cast<std::size_t>((row * scene_.nx + inside) * 3 + component),
             static_cast<std::size_t>(component * stride_ + margin + row * pitch_ + x));
      }
}
template <class Real>
void Probe<Real>::set(std::vector<double> const& spins) {
  for_each_site([&](std::size_t number, std::size_t at) {
    fields_[0][at] = static_cast<Real>(spins[number]);
  });
}
template <class Real>
std::vector<double> Probe<Real>::get() const {
  std::vector<double> spins(static_cast<std::size_t>(3 * scene_.nx) * scene_.ny * scene_.nz);
  for_each_site([&](std::size_t number, std::size_t at) {
    spins[number] = static_cast<double>(fields_[0][at]);
  });
  return spins;
}

template <class Real>
void Probe<Real>::euler(Real dt) {
  for_each_pack<true>(
      0, 1, [&](auto at, auto const& m, auto const& a) { write(cayley<Real>(dt * a, m), 1, at); });
  fields_[0].swap(fields_[1]);
}

template <class Real>
void Probe<Real>::heun(Real dt) {
  for_each_pack<true>(0, 1, [&](auto at, auto const& m, auto const& a) {
    auto const f = dt * a;
    write(f, 2, at);
    write(cayley<Real>(f, m), 1, at);
  });
  for_each_pack<true>(1, 0, [&](auto at, auto const&, auto const& a) {
    auto const f = Real(0.5) * (read(2, at) + dt * a);
    write(cayley<Real>(f, read(0, at)), 0, at);
  });
}

template <class Real>
void Probe<Real>::rkmk4(Real dt) {
  for_each_pack<true>(0, 1, [&](auto at, auto const& m, auto const& a) {
    auto const f = dt * a;
    write(f, 3, at);
    write(cayley<Real>(Real(0.5) * f, m), 1, at);
  });
  for_each_pack<true>(1, 2, [&](auto at, auto const&, auto const& a) {
    auto const before = read(3, at);
    auto const f = dcay_inverse<Real>(Real(0.5) * before, dt * a);
    write(f, 3, at);
    write(before + Real(2) * f, 4, at);
    write(cayley<Real>(Real(0.5) * f, read(0, at)), 2, at);
  });
  for_each_pack<true>(2, 1, [&](auto at, auto const&, auto const& a) {
    auto const f = dcay_inverse<Real>(Real(0.5) * read(3, at), dt * a);
    write(f, 3, at);
    write(cayley<Real>(f, read(0, at)), 1, at);
  });
  for_each_pack<true>(1, 0, [&](auto at, auto const&, auto const& a) {
    auto const before = read(3, at);
    auto const f = dcay_inverse<Real>(before, dt * a);
    auto const sum = Real(1. / 6) * (read(4, at) + Real(2) * before + f);
    write(cayley<Real>(sum, read(0, at)), 0, at);
  });
}

template <class Real>
void Probe<Real>::chart_heun(Real dt) {
  for_each_pack<false>(0, 1, [&](auto at, auto const& m, auto const& a) {
    write(chart_to<Real>((Real(0.5) * dt) * cross(a, m), m), 1, at);
  });
  for_each_pack<false>(1, 0, [&](auto at, auto const& m, auto const& a) {
    auto const m0 = read(0, at);
    auto const f = chart_of<Real>(m, m0) + dt * chart_rate<Real>(cross(a, m), m, m0);
    write(chart_to<Real>(Real(0.5) * f, m0), 0, at);
  });
}

template <class Real>
void Probe<Real>::chart_rk4(Real dt) {
  for_each_pack<false>(0, 1, [&](auto at, auto const& m, auto const& a) {
    write(chart_to<Real>((Real(0.25) * dt) * cross(a, m), m), 1, at);
  });
  for_each_pack<false>(1, 2, [&](auto at, auto const& m, auto const& a) {
    write(chart_move<Real>(Real(0.5) * dt, cross(a, m), m, read(0, at)), 2, at);
  });
  for_each_pack<false>(2, 3, [&](auto at, auto const& m, auto const& a) {
    write(chart_move<Real>(dt, cross(a, m), m, read(0, at)), 3, at);
  });
  for_each_pack<false>(3, 0, [&](auto at, auto const& m, auto const& a) {
    auto const m0 = read(0, at);
    auto const f = chart_of<Real>(read(1, at), m0) + Real(2) * chart_of<Real>(read(2, at), m0) +
                   chart_of<Real>(m, m0) + (Real(0.5) * dt) * chart_rate<Real>(cross(a, m), m, m0);
    write(chart_to<Real>(Real(1. / 3) * f, m0), 0, at);
  });
}

template <class Real>
void Probe<Real>::projected_rk4(Real dt) {
  for_each_pack<false>(0, 1, [&](auto at, auto const& m, auto const& a) {
    auto const k = cross(a, m);
    write(k, 3, at);
    write(m + (Real(0.5) * dt) * k, 1, at);
  });
  for_each_pack<false>(1, 2, [&](auto at, auto const& m, auto const& a) {
    auto const k = cross(a, m);
    write(read(3, at) + Real(2) * k, 3, at);
    write(read(0, at) + (Real(0.5) * dt) * k, 2, at);
  });
  for_each_pack<false>(2, 1, [&](auto at, auto const& m, auto const& a) {
    auto const k = cross(a, m);
    write(read(3, at) + Real(2) * k, 3, at);
    write(read(0, at) + dt * k, 1, at);
  });
  for_each_pack<false>(1, 0, [&](auto at, auto const& m, auto const& a) {
    auto const k = read(3, at) + cross(a, m);
    auto const end = read(0, at) + (dt * Real(1. / 6)) * k;
    write((Real(1) / root(dot(end, end))) * end, 0, at);
  });
}

template class Probe<float>;
template class Probe<double>;

}  // namespace probes
