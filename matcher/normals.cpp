#include "matcher/normals.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "matcher/lanes.h"
#include "matcher/neighbour_sums.h"
#include "matcher/parallel.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr float kMaxSlope = 3.f;  // depth change over lateral distance that still is one surface (72 degrees)
constexpr int kMinNeighbours = 12;  // of 36
constexpr int kRowsPerJob = 32;
constexpr int kNoiseStride = 5;          // pixels between two whose residuals are looked at, and
constexpr int kNoiseRows = 4;            // rows: ten thousands of samples are plenty
constexpr size_t kMinNoiseSamples = 50;  // in a range of depth
constexpr float kCorrelated =
    2.5f;  // sensors smooth: neighbours differ by less than the error of the surface

struct Intrinsics {
  float fx, fy, cx, cy;  // pixels
  explicit Intrinsics(const Camera& c)
      : fx(static_cast<float>(c.fx)),
        fy(static_cast<float>(c.fy)),
        cx(static_cast<float>(c.cx)),
        cy(static_cast<float>(c.cy)) {}
};

/// Inverse depth of some rows with a margin of pixels without measurement, so that no neighbour needs a
/// bounds check. In inverse depth a plane is linear in the pixel coordinates, whatever its slope.
class InverseDepth {
 public:
  InverseDepth(const Scene::Data& scene, int first, int last)
      : first_(first - kMargin),
        stride_(static_cast<size_t>(scene.width + 2 * kMargin)),
        values_(stride_ * static_cast<size_t>(last - first + 2 * kMargin) + kLanes, kNoInverseDepth) {
    for (int v = std::max(0, first_); v < std::min(scene.height, last + kMargin); ++v) {
      const float* depth = scene.depth.data() + scene.index(0, v);
      float* out = values_.data() + at(v);
      for (int u = 0; u < scene.width; ++u) out[u] = depth[u] > 0 ? 1 / depth[u] : kNoInverseDepth;
    }
  }
  const float* row(int v) const { return values_.data() + at(v); }

 private:
  static constexpr int kMargin = kNeighbourOffsets.back();
  size_t at(int v) const { return static_cast<size_t>(v - first_) * stride_ + kMargin; }

  int first_;
  size_t stride_;
  std::vector<float> values_;
};

/// The fitted planes of a row: unit normal towards the camera, depth at the pixel [m], residual [m]
/// (negative: no fit; then all else is zero).
struct RowPlanes {
  float *nx, *ny, *nz, *depth, *residual;
};

/// Solves the fits of row v.
EDGEPOSE_WIDE_SIMD void fit_planes(const NeighbourSums& sums, const float* inverse, int width, float v,
                                   Intrinsics camera, RowPlanes planes) {
  const float *sn = sums.n.data(), *x = sums.x.data(), *y = sums.y.data(), *xx = sums.xx.data(),
              *xy = sums.xy.data(), *yy = sums.yy.data(), *w = sums.w.data(), *xw = sums.xw.data(),
              *yw = sums.yw.data(), *ww = sums.ww.data();
  EDGEPOSE_NO_OVERLAP
  for (int u = 0; u < width; ++u) {
    const float n = std::max(sn[u], 1.f), mx = x[u] / n, my = y[u] / n, mw = w[u] / n;
    const float cxx = xx[u] - n * mx * mx, cxy = xy[u] - n * mx * my, cyy = yy[u] - n * my * my;
    const float cxw = xw[u] - n * mx * mw, cyw = yw[u] - n * my * mw;
    const float determinant = cxx * cyy - cxy * cxy;
    const float a = (cxw * cyy - cyw * cxy) / determinant, b = (cyw * cxx - cxw * cxy) / determinant;
    const float fitted = inverse[u] + mw - a * mx - b * my;  // inverse depth of the plane at the pixel
    const float squares = std::max(0.f, ww[u] - n * mw * mw - a * cxw - b * cyw);
    const float spread = 0.02f * (cxx + cyy) * (cxx + cyy);  // below: nearly a line of pixels
    float sound = inverse[u] > 0 ? determinant - spread : -1.f;
    sound = n >= static_cast<float>(kMinNeighbours) ? sound : -1.f;
    sound = fitted > 0.2f * inverse[u] ? sound : -1.f;
    const float rms = std::sqrt(squares / std::max(1.f, n - 3)) / (inverse[u] * inverse[u]);
    planes.residual[u] = sound > 0 ? rms : -1.f;
    planes.depth[u] = sound > 0 ? 1 / fitted : 0.f;
    // The plane n.X = D has inverse depth (n.ray) / D, so its normal can be read off the fit; n.X > 0 points
    // away from the camera.
    const float nx = a * camera.fx, ny = b * camera.fy,
                nz = fitted + a * (camera.cx - static_cast<float>(u)) + b * (camera.cy - v);
    const float scale = sound > 0 ? -1 / std::sqrt(nx * nx + ny * ny + nz * nz) : 0.f;
    planes.nx[u] = sound > 0 ? nx * scale : 0.f;
    planes.ny[u] = sound > 0 ? ny * scale : 0.f;
    planes.nz[u] = sound > 0 ? nz * scale : 0.f;
  }
}

/// The noise that neighbouring pixels alone show, without what curvature adds to a wide plane fit: from the
/// second differences of depth, whose deviation is sqrt(6) times that of one pixel. The largest fifth, edges
/// among them, is left out. Empty with too few values.
std::optional<float> noise_of_differences(std::vector<float>& differences) {
  constexpr float kKept = 0.8f;
  constexpr float kTrimmedMean = 0.5586f;  // of |x| for the kept part of a standard normal distribution
  if (differences.size() < kMinNoiseSamples) return std::nullopt;
  const auto kept = static_cast<long>(kKept * static_cast<float>(differences.size()));
  std::nth_element(differences.begin(), differences.begin() + kept, differences.end());
  const double mean =
      std::accumulate(differences.begin(), differences.begin() + kept, 0.) / static_cast<double>(kept);
  return static_cast<float>(mean) / kTrimmedMean / std::sqrt(6.f);
}

/// Second differences of depth in both directions at a sample of the fitted pixels, by range of depth.
std::array<std::vector<float>, NoiseCurve::kBins> second_differences(const Scene::Data& scene) {
  std::array<std::vector<float>, NoiseCurve::kBins> samples;
  for (int v = 1; v + 1 < scene.height; v += kNoiseRows)
    for (int u = 1 + v % kNoiseStride; u + 1 < scene.width; u += kNoiseStride) {
      const size_t at = scene.index(u, v), row = static_cast<size_t>(scene.width);
      if (scene.smooth_depth[at] <= 0) continue;
      const float z = scene.depth[at];
      auto& bin = samples[NoiseCurve::bin(z)];
      for (const auto& [before, after] : {std::pair{at - 1, at + 1}, {at - row, at + row}})
        if (scene.depth[before] > 0 && scene.depth[after] > 0)
          bin.push_back(std::abs(scene.depth[before] + scene.depth[after] - 2 * z));
    }
  return samples;
}

/// Values by range of depth.
template <typename T>
using ByDepth = std::array<T, NoiseCurve::kBins>;

/// The median of the residuals in each range of depth; none where there are too few.
/// `residuals`: of every kNoiseRows-th row.
ByDepth<std::optional<float>> median_residuals(const Scene::Data& scene,
                                               const std::vector<float>& residuals) {
  ByDepth<std::vector<float>> samples;
  for (int v = 0; v < scene.height; v += kNoiseRows)
    for (int u = v % kNoiseStride; u < scene.width; u += kNoiseStride) {
      const float residual = residuals[scene.index(u, v / kNoiseRows)];
      if (residual >= 0) samples[NoiseCurve::bin(scene.depth[scene.index(u, v)])].push_back(residual);
    }
  ByDepth<std::optional<float>> medians;
  for (size_t b = 0; b < samples.size(); ++b) {
    auto& s = samples[b];
    if (s.size() < kMinNoiseSamples) continue;
    std::nth_element(s.begin(), s.begin() + static_cast<long>(s.size() / 2), s.end());
    medians[b] = s[s.size() / 2];
  }
  return medians;
}

/// The median residual of the plane fits in each range of depth, but no more than a few times what
/// neighbouring pixels differ by: a scene of small curved objects has no planes to read the noise from.
/// Ranges with little data take their neighbour's.
NoiseCurve noise_curve(const Scene::Data& scene, const std::vector<float>& residuals, int threads) {
  ByDepth<std::optional<float>> of_planes, of_pixels;
  parallel_for(2, threads, [&](size_t job) {
    if (job == 1) {
      of_planes = median_residuals(scene, residuals);
      return;
    }
    auto differences = second_differences(scene);
    for (size_t b = 0; b < differences.size(); ++b) of_pixels[b] = noise_of_differences(differences[b]);
  });
  NoiseCurve curve;
  for (int b = 0; b < NoiseCurve::kBins; ++b) {
    if (!of_planes[b]) continue;
    curve.sigma[b] = *of_planes[b];
    if (of_pixels[b]) curve.sigma[b] = std::min(curve.sigma[b], kCorrelated * *of_pixels[b]);
  }
  for (int b = 1; b < NoiseCurve::kBins; ++b)
    if (curve.sigma[b] <= 0) curve.sigma[b] = curve.sigma[b - 1];
  for (int b = NoiseCurve::kBins - 2; b >= 0; --b)
    if (curve.sigma[b] <= 0) curve.sigma[b] = curve.sigma[b + 1];
  return curve;
}

}  // namespace

void estimate_normals(Scene::Data& scene, int threads) {
  const size_t pixels = scene.depth.size(), width = static_cast<size_t>(scene.width);
  // A slope s changes the inverse depth by s / (f z) a pixel.
  const Intrinsics intrinsics(scene.camera);
  const SurfaceReach reach(kMaxSlope / static_cast<float>(scene.camera.fx));
  scene.normals.resize(pixels);
  scene.smooth_depth.resize(pixels);
  std::vector<float> residuals(width * static_cast<size_t>((scene.height + kNoiseRows - 1) / kNoiseRows));
  const size_t jobs = static_cast<size_t>((scene.height + kRowsPerJob - 1) / kRowsPerJob);
  parallel_for(jobs, threads, [&](size_t job) {
    NeighbourSums sums(width);
    std::vector<float> nx(width), ny(width), nz(width), unused(width);
    const int first = static_cast<int>(job) * kRowsPerJob, last = std::min(scene.height, first + kRowsPerJob);
    const InverseDepth inverse(scene, first, last);
    for (int v = first; v < last; ++v) {
      const size_t at = scene.index(0, v);
      std::array<const float*, kNeighbourOffsets.size()> rows;
      for (size_t r = 0; r < rows.size(); ++r) rows[r] = inverse.row(v + kNeighbourOffsets[r]);
      sum_neighbours(rows, inverse.row(v), reach, sums);
      float* residual =
          v % kNoiseRows == 0 ? residuals.data() + scene.index(0, v / kNoiseRows) : unused.data();
      fit_planes(sums, inverse.row(v), scene.width, static_cast<float>(v), intrinsics,
                 {nx.data(), ny.data(), nz.data(), scene.smooth_depth.data() + at, residual});
      for (size_t u = 0; u < width; ++u) scene.normals[at + u] = {nx[u], ny[u], nz[u]};
    }
  });
  scene.noise = noise_curve(scene, residuals, threads);
}

}  // namespace edgepose
