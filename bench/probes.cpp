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
/// The spin that stereographic coordinates `step` times u, moved from m to m0, lead to.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_move(Real step, Vector<P> const& u, Vector<P> const& m,
                                  Vector<P> const& m0) {
  P const e2 = Real(2) * dot(m, m0) + Real(2);
  P const reach = step * dot(u, u);
  P const scale = (Real(4) * step) / (e2 * e2 + (Real(4) * step) * reach);
  P const along = Real(-2) * scale * dot(u, m0);
  return m0 + (along - Real(2) * scale * reach) * m0 + (scale * e2) * u + along * m;
}
/// The coordinates that lead from m0 to w.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_of(Vector<P> const& w, Vector<P> const& m0) {
  Vector<P> const d = w - m0;
  P const square = dot(d, d);
  return (Real(1) / (Real(4) - square)) * ((d + d) + square * m0);
}
template <class Real, class P>
PROBE_INLINE Vector<P> chart_to(Vector<P> const& f, Vector<P> const& m0) {
  P const s = dot(f, f);
  return m0 + (Real(2) / (Real(1) + s)) * (f - s * m0);
}
/// u at m in coordinates at m0.
template <class Real, class P>
PROBE_INLINE Vector<P> chart_rate(Vector<P> const& u, Vector<P> const& m, Vector<P> const& m0) {
  P const inverse = Real(2) / (Real(2) * dot(m, m0) + Real(2));
  return inverse * (u - (inverse * dot(u, m0)) * (m + m0));
}

template <class Real>
class OnRows : public Probe<Real> {
 protected:
  using P = Pack<Real>;
  using V = Vector<P>;
  static constexpr int margin = 64 / static_cast<int>(sizeof(Real));

  explicit OnRows(Scene const& scene)
      : scene_(scene),
        pitch_(scene.nx + 2 * margin),
        stride_(pitch_ * scene.ny * scene.nz + margin) {
    for (auto& field : fields_) field.assign(static_cast<std::size_t>(3 * stride_), Real(0));
  }

  V read(int field, std::ptrdiff_t at) const {
    Real const* const from = fields_[static_cast<std::size_t>(field)].data() + at;
    return {load(from), load(from + stride_), load(from + 2 * stride_)};
  }
  void write(V const& v, int field, std::ptrdiff_t at) {
    Real* const to = fields_[static_cast<std::size_t>(field)].data() + at;
    store(v.x, to), store(v.y, to + stride_), store(v.z, to + 2 * stride_);
  }

  /// Calls body(at, m, A) for each pack of the spins `level`, then writes the ghost sites of `out`.
  /// Without Whole, A is up to a multiple of m.
  template <bool Whole, class Body>
  PROBE_INLINE void for_each_pack(int level, int out, Body const& body) {
    auto const exchange = static_cast<Real>(scene_.exchange);
    auto const anisotropy = static_cast<Real>(scene_.anisotropy);
    auto const applied = static_cast<Real>(scene_.applied);
    auto const damping = static_cast<Real>(scene_.damping);
    Real const* const spins = fields_[static_cast<std::size_t>(level)].data();
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
          V const m{load(from), load(from + stride), load(from + 2 * stride)};
          V h{pairs(from, to), pairs(from + stride, to), pairs(from + 2 * stride, to)};
          if constexpr (Whole) h = h - Real(6) * m;
          h = exchange * h;
          h.z += anisotropy * m.z + applied;
          body(at, m, h + damping * cross(m, h));
        }
        for (int component = 0; component < 3; ++component) {
          Real* const begin =
              fields_[static_cast<std::size_t>(out)].data() + component * stride + row;
          begin[-1] = begin[0];
          begin[scene_.nx] = begin[scene_.nx - 1];
        }
      }
  }

  std::vector<Real> fields_[7];  // the spins are the first

 public:
  void set(std::vector<double> const& spins) override {
    for_each_site([&](std::size_t number, std::ptrdiff_t at) {
      fields_[0][static_cast<std::size_t>(at)] = static_cast<Real>(spins[number]);
    });
  }
  std::vector<double> get() const override {
    std::vector<double> spins(static_cast<std::size_t>(3 * scene_.nx) * scene_.ny * scene_.nz);
    for_each_site([&](std::size_t number, std::ptrdiff_t at) {
      spins[number] = static_cast<double>(fields_[0][static_cast<std::size_t>(at)]);
    });
    return spins;
  }

 private:
  // With the ghost sites, which are those beside them.
  template <class Work>
  void for_each_site(Work const& work) const {
    for (int row = 0; row < scene_.ny * scene_.nz; ++row)
      for (int x = -1; x <= scene_.nx; ++x)
        for (int component = 0; component < 3; ++component) {
          int const inside = x < 0 ? 0 : x < scene_.nx ? x : scene_.nx - 1;
          work(static_cast<std::size_t>((row * scene_.nx + inside) * 3 + component),
               component * stride_ + margin + row * pitch_ + x);
        }
  }

  Scene scene_;
  std::ptrdiff_t pitch_, stride_;
};

#define PROBE_MEMBERS(Name)                                  \
 public:                                                     \
  explicit Name(Scene const& scene) : OnRows<Real>(scene) {} \
                                                             \
 private:                                                    \
  using typename OnRows<Real>::V;                            \
  using OnRows<Real>::fields_;

template <class Real>
class Euler : public OnRows<Real> {
  PROBE_MEMBERS(Euler)
  void step(Real dt) override {
    this->template for_each_pack<true>(0, 1, [&](auto at, V const& m, V const& a) {
      this->write(cayley<Real>(dt * a, m), 1, at);
    });
    fields_[0].swap(fields_[1]);
  }
};

template <class Real>
class Heun : public OnRows<Real> {
  PROBE_MEMBERS(Heun)
  void step(Real dt) override {
    this->template for_each_pack<true>(0, 1, [&](auto at, V const& m, V const& a) {
      V const f = dt * a;
      this->write(f, 2, at);
      this->write(cayley<Real>(f, m), 1, at);
    });
    this->template for_each_pack<true>(1, 0, [&](auto at, V const&, V const& a) {
      V const f = Real(0.5) * (this->read(2, at) + dt * a);
      this->write(cayley<Real>(f, this->read(0, at)), 0, at);
    });
  }
};

template <class Real>
class Rkmk4 : public OnRows<Real> {
  PROBE_MEMBERS(Rkmk4)
  void step(Real dt) override {
    this->template for_each_pack<true>(0, 1, [&](auto at, V const& m, V const& a) {
      V const f = dt * a;
      this->write(f, 3, at);
      this->write(cayley<Real>(Real(0.5) * f, m), 1, at);
    });
    this->template for_each_pack<true>(1, 2, [&](auto at, V const&, V const& a) {
      V const before = this->read(3, at);
      V const f = dcay_inverse<Real>(Real(0.5) * before, dt * a);
      this->write(f, 3, at);
      this->write(before + Real(2) * f, 4, at);
      this->write(cayley<Real>(Real(0.5) * f, this->read(0, at)), 2, at);
    });
    this->template for_each_pack<true>(2, 1, [&](auto at, V const&, V const& a) {
      V const f = dcay_inverse<Real>(Real(0.5) * this->read(3, at), dt * a);
      this->write(f, 3, at);
      this->write(cayley<Real>(f, this->read(0, at)), 1, at);
    });
    this->template for_each_pack<true>(1, 0, [&](auto at, V const&, V const& a) {
      V const before = this->read(3, at);
      V const f = dcay_inverse<Real>(before, dt * a);
      V const sum = Real(1. / 6) * (this->read(4, at) + Real(2) * before + f);
      this->write(cayley<Real>(sum, this->read(0, at)), 0, at);
    });
  }
};

template <class Real>
class ChartHeun : public OnRows<Real> {
  PROBE_MEMBERS(ChartHeun)
  void step(Real dt) override {
    this->template for_each_pack<false>(0, 1, [&](auto at, V const& m, V const& a) {
      this->write(chart_to<Real>((Real(0.5) * dt) * cross(a, m), m), 1, at);
    });
    this->template for_each_pack<false>(1, 0, [&](auto at, V const& m, V const& a) {
      V const m0 = this->read(0, at);
      V const f = chart_of<Real>(m, m0) + dt * chart_rate<Real>(cross(a, m), m, m0);
      this->write(chart_to<Real>(Real(0.5) * f, m0), 0, at);
    });
  }
};

template <class Real>
class ChartRk4 : public OnRows<Real> {
  PROBE_MEMBERS(ChartRk4)
  void step(Real dt) override {
    this->template for_each_pack<false>(0, 1, [&](auto at, V const& m, V const& a) {
      this->write(chart_to<Real>((Real(0.25) * dt) * cross(a, m), m), 1, at);
    });
    this->template for_each_pack<false>(1, 2, [&](auto at, V const& m, V const& a) {
      this->write(chart_move<Real>(Real(0.5) * dt, cross(a, m), m, this->read(0, at)), 2, at);
    });
    this->template for_each_pack<false>(2, 3, [&](auto at, V const& m, V const& a) {
      this->write(chart_move<Real>(dt, cross(a, m), m, this->read(0, at)), 3, at);
    });
    this->template for_each_pack<false>(3, 0, [&](auto at, V const& m, V const& a) {
      V const m0 = this->read(0, at);
      V const f = chart_of<Real>(this->read(1, at), m0) +
                  Real(2) * chart_of<Real>(this->read(2, at), m0) + chart_of<Real>(m, m0) +
                  (Real(0.5) * dt) * chart_rate<Real>(cross(a, m), m, m0);
      this->write(chart_to<Real>(Real(1. / 3) * f, m0), 0, at);
    });
  }
};

template <class Real>
class ProjectedRk4 : public OnRows<Real> {
  PROBE_MEMBERS(ProjectedRk4)
  void step(Real dt) override {
    this->template for_each_pack<false>(0, 1, [&](auto at, V const& m, V const& a) {
      V const k = cross(a, m);
      this->write(k, 3, at);
      this->write(m + (Real(0.5) * dt) * k, 1, at);
    });
    this->template for_each_pack<false>(1, 2, [&](auto at, V const& m, V const& a) {
      V const k = cross(a, m);
      this->write(this->read(3, at) + Real(2) * k, 3, at);
      this->write(this->read(0, at) + (Real(0.5) * dt) * k, 2, at);
    });
    this->template for_each_pack<false>(2, 1, [&](auto at, V const& m, V const& a) {
      V const k = cross(a, m);
      this->write(this->read(3, at) + Real(2) * k, 3, at);
      this->write(this->read(0, at) + dt * k, 1, at);
    });
    this->template for_each_pack<false>(1, 0, [&](auto at, V const& m, V const& a) {
      V const k = this->read(3, at) + cross(a, m);
      V const end = this->read(0, at) + (dt * Real(1. / 6)) * k;
      this->write((Real(1) / root(dot(end, end))) * end, 0, at);
    });
  }
};

}  // namespace

#define PROBE(name, Type)                         \
  template <class Real>                           \
  Made<Real> name(Scene const& scene) {           \
    return std::make_unique<Type<Real>>(scene);   \
  }                                               \
  template Made<float> name<float>(Scene const&); \
  template Made<double> name<double>(Scene const&);

PROBE(euler, Euler)
PROBE(heun, Heun)
PROBE(rkmk4, Rkmk4)
PROBE(chart_heun, ChartHeun)
PROBE(chart_rk4, ChartRk4)
PROBE(projected_rk4, ProjectedRk4)

}  // namespace probes
