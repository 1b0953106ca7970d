#include "matcher/normals.h"

#include <algorithm>
#include <array>

#include "matcher/parallel.h"

namespace edgepose {
namespace {

constexpr std::array<int, 6> kOffsets = {-5, -3, -1, 1, 3, 5};  // pixels
constexpr float kMaxSlope = 3.f;  // depth change over lateral distance that still is one surface (72 degrees)
constexpr int kMinNeighbours = 12;  // of 36
constexpr int kRowsPerJob = 8;

/// Sums of the least-squares fit w = a du + b dv + c for a whole row; structure of arrays, so that the
/// compiler vectorises the inner loop.
struct RowSums {
  explicit RowSums(size_t width)
      : n(width),
        x(width),
        y(width),
        xx(width),
        xy(width),
        yy(width),
        w(width),
        xw(width),
        yw(width),
        ww(width) {}
  void clear() {
    for (auto* sum : {&n, &x, &y, &xx, &xy, &yy, &w, &xw, &yw, &ww}) std::fill(sum->begin(), sum->end(), 0.f);
  }
  std::vector<float> n, x, y, xx, xy, yy, w, xw, yw, ww;
};

/// Adds the neighbours (u + du, v + dv) of all pixels of row v that lie on the same surface. In inverse
/// depth a plane is linear in the pixel coordinates, whatever its slope.
void add_neighbours(const Scene::Data& scene, const std::vector<float>& inverse,
                    const std::vector<float>& tolerance, int v, int du, int dv, RowSums& sums) {
  const int first = std::max(0, -du), last = std::min(scene.width, scene.width - du);
  const float* centre = inverse.data() + static_cast<size_t>(v) * scene.width;
  const float* allowed = tolerance.data() + static_cast<size_t>(v) * scene.width;
  const float* other = inverse.data() + static_cast<size_t>(v + dv) * scene.width + du;
  const float dx = static_cast<float>(du), dy = static_cast<float>(dv);
  const float reach = std::sqrt(dx * dx + dy * dy) + 2.f;  // the two pixels more absorb noise
  float *n = sums.n.data(), *x = sums.x.data(), *y = sums.y.data(), *xx = sums.xx.data(),
        *xy = sums.xy.data(), *yy = sums.yy.data(), *w = sums.w.data(), *xw = sums.xw.data(),
        *yw = sums.yw.data(), *ww = sums.ww.data();
  for (int u = first; u < last; ++u) {
    const float difference = other[u] - centre[u];  // relative to the centre: keeps single precision accurate
    const bool same = std::abs(difference) < allowed[u] * reach && other[u] > 0.f;
    const float m = same ? 1.f : 0.f, d = same ? difference : 0.f;
    n[u] += m, x[u] += m * dx, y[u] += m * dy;
    xx[u] += m * (dx * dx), xy[u] += m * (dx * dy), yy[u] += m * (dy * dy);
    w[u] += d, xw[u] += dx * d, yw[u] += dy * d, ww[u] += d * d;
  }
}

/// Solves the fit of one pixel; returns the residual [m], or a negative number if there is no fit.
float fit_plane(Scene::Data& scene, const RowSums& s, float inverse, int u, int v) {
  const size_t at = scene.index(u, v);
  const float n = s.n[u];
  if (inverse <= 0 || n < kMinNeighbours) return -1;
  const float mx = s.x[u] / n, my = s.y[u] / n, mw = s.w[u] / n;
  const float cxx = s.xx[u] - n * mx * mx, cxy = s.xy[u] - n * mx * my, cyy = s.yy[u] - n * my * my;
  const float cxw = s.xw[u] - n * mx * mw, cyw = s.yw[u] - n * my * mw;
  const float determinant = cxx * cyy - cxy * cxy;
  if (determinant < 0.02f * (cxx + cyy) * (cxx + cyy) || determinant <= 0)
    return -1;  // nearly a line of pixels
  const float a = (cxw * cyy - cyw * cxy) / determinant, b = (cyw * cxx - cxw * cxy) / determinant;
  const float fitted = inverse + mw - a * mx - b * my;  // inverse depth of the plane at the pixel
  if (!(fitted > 0.2f * inverse)) return -1;

  const Camera& c = scene.camera;
  const float fx = static_cast<float>(c.fx), fy = static_cast<float>(c.fy);
  // The plane n.X = D has inverse depth (n.ray) / D, so its normal can be read off the fit.
  const Eigen::Vector3f normal(a * fx, b * fy,
                               fitted + a * (static_cast<float>(c.cx) - static_cast<float>(u)) +
                                   b * (static_cast<float>(c.cy) - static_cast<float>(v)));
  scene.normals[at] = -normal.normalized();  // n.X > 0 points away from the camera
  scene.smooth_depth[at] = 1 / fitted;
  const float squares = s.ww[u] - n * mw * mw - a * cxw - b * cyw;
  return std::sqrt(std::max(0.f, squares) / (n - 3)) / (inverse * inverse);
}

/// The median residual in each range of depth; ranges with little data take their neighbour's.
NoiseCurve noise_curve(const Scene::Data& scene, const std::vector<float>& residuals) {
  std::array<std::vector<float>, NoiseCurve::kBins> samples;
  for (size_t i = 0; i < residuals.size(); i += 5)
    if (residuals[i] >= 0) samples[NoiseCurve::bin(scene.depth[i])].push_back(residuals[i]);
  NoiseCurve curve;
  for (int b = 0; b < NoiseCurve::kBins; ++b) {
    auto& s = samples[b];
    if (s.size() < 50) continue;
    std::nth_element(s.begin(), s.begin() + static_cast<long>(s.size() / 2), s.end());
    curve.sigma[b] = s[s.size() / 2];
  }
  for (int b = 1; b < NoiseCurve::kBins; ++b)
    if (curve.sigma[b] <= 0) curve.sigma[b] = curve.sigma[b - 1];
  for (int b = NoiseCurve::kBins - 2; b >= 0; --b)
    if (curve.sigma[b] <= 0) curve.sigma[b] = curve.sigma[b + 1];
  return curve;
}

}  // namespace

void estimate_normals(Scene::Data& scene, int threads) {
  const size_t pixels = scene.depth.size();
  std::vector<float> inverse(pixels), tolerance(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    inverse[i] = scene.depth[i] > 0 ? 1 / scene.depth[i] : 0.f;
    // A slope s changes the inverse depth by s / (f z) a pixel.
    tolerance[i] = inverse[i] * kMaxSlope / static_cast<float>(scene.camera.fx);
  }
  scene.normals.assign(pixels, Eigen::Vector3f::Zero());
  scene.smooth_depth.assign(pixels, 0.f);

  std::vector<float> residuals(pixels, -1.f);
  const size_t jobs = static_cast<size_t>((scene.height + kRowsPerJob - 1) / kRowsPerJob);
  parallel_for(jobs, threads, [&](size_t job) {
    RowSums sums(static_cast<size_t>(scene.width));
    const int first = static_cast<int>(job) * kRowsPerJob, last = std::min(scene.height, first + kRowsPerJob);
    for (int v = first; v < last; ++v) {
      sums.clear();
      for (int dv : kOffsets)
        if (v + dv >= 0 && v + dv < scene.height)
          for (int du : kOffsets) add_neighbours(scene, inverse, tolerance, v, du, dv, sums);
      for (int u = 0; u < scene.width; ++u)
        residuals[scene.index(u, v)] = fit_plane(scene, sums, inverse[scene.index(u, v)], u, v);
    }
  });
  scene.noise = noise_curve(scene, residuals);
}

}  // namespace edgepose
