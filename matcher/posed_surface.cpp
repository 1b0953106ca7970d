#include "matcher/posed_surface.h"

#include "matcher/lanes.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

/// Pose and camera as plain numbers, so that no Eigen type enters the loop.
struct Placement {
  float r[3][3], t[3];
  float fx, fy, cx, cy;
  int width, height;
};

struct PointColumns {
  const float *x, *y, *z, *nx, *ny, *nz;
};

struct PlacedColumns {
  float *x, *y, *z, *nx, *ny, *nz, *ray_x, *ray_y;
  int32_t* pixel;
};

EDGEPOSE_WIDE_SIMD void place_points(Placement at, PointColumns in, size_t count, PlacedColumns out) {
  const float width = static_cast<float>(at.width), height = static_cast<float>(at.height);
  EDGEPOSE_NO_OVERLAP
  for (size_t i = 0; i < count; ++i) {
    const float mx = in.x[i], my = in.y[i], mz = in.z[i];
    const float x = at.r[0][0] * mx + at.r[0][1] * my + at.r[0][2] * mz + at.t[0];
    const float y = at.r[1][0] * mx + at.r[1][1] * my + at.r[1][2] * mz + at.t[1];
    const float z = at.r[2][0] * mx + at.r[2][1] * my + at.r[2][2] * mz + at.t[2];
    const float ax = in.nx[i], ay = in.ny[i], az = in.nz[i];
    out.nx[i] = at.r[0][0] * ax + at.r[0][1] * ay + at.r[0][2] * az;
    out.ny[i] = at.r[1][0] * ax + at.r[1][1] * ay + at.r[1][2] * az;
    out.nz[i] = at.r[2][0] * ax + at.r[2][1] * ay + at.r[2][2] * az;
    out.x[i] = x, out.y[i] = y, out.z[i] = z;
    const float inverse = 1 / z;
    const float u = at.fx * x * inverse + at.cx + 0.5f, v = at.fy * y * inverse + at.cy + 0.5f;
    // One sum of what is wrong instead of conditions, which would not be computed side by side.
    int outside = z > 1e-3f ? 0 : 1;
    outside |= u >= 0 ? 0 : 1;
    outside |= v >= 0 ? 0 : 1;
    outside |= u < width ? 0 : 1;
    outside |= v < height ? 0 : 1;
    const int column = static_cast<int>(outside ? 0.f : u), row = static_cast<int>(outside ? 0.f : v);
    out.ray_x[i] = (static_cast<float>(column) - at.cx) / at.fx;
    out.ray_y[i] = (static_cast<float>(row) - at.cy) / at.fy;
    out.pixel[i] = outside ? -1 : row * at.width + column;
  }
}

}  // namespace

void PosedSurface::take(const Model::View& model, size_t view, size_t limit) {
  if (model.dense_points.data() == points_ && view == view_ && limit == limit_) return;
  points_ = model.dense_points.data(), view_ = view, limit_ = limit;
  indices.clear();
  for_visible_points(model, view, limit, [&](size_t i) { indices.push_back(static_cast<uint32_t>(i)); });
  const size_t room = whole_lanes(indices.size());
  for (auto* column : {&model_x_, &model_y_, &model_z_, &model_nx_, &model_ny_, &model_nz_, &x, &y, &z, &nx,
                       &ny, &nz, &ray_x, &ray_y})
    column->assign(room, 0.f);
  pixel.assign(room, -1);
  for (size_t k = 0; k < indices.size(); ++k) {
    const OrientedPoint& p = model.dense_points[indices[k]];
    model_x_[k] = p.position.x(), model_y_[k] = p.position.y(), model_z_[k] = p.position.z();
    model_nx_[k] = p.normal.x(), model_ny_[k] = p.normal.y(), model_nz_[k] = p.normal.z();
  }
}

void PosedSurface::place(const PoseF& pose, const PixelProjection& projection) {
  Placement at{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) at.r[row][column] = pose.rotation(row, column);
    at.t[row] = pose.translation[row];
  }
  at.fx = projection.fx, at.fy = projection.fy, at.cx = projection.cx, at.cy = projection.cy;
  at.width = projection.width, at.height = projection.height;
  place_points(at,
               {model_x_.data(), model_y_.data(), model_z_.data(), model_nx_.data(), model_ny_.data(),
                model_nz_.data()},
               padded(),
               {x.data(), y.data(), z.data(), nx.data(), ny.data(), nz.data(), ray_x.data(), ray_y.data(),
                pixel.data()});
  for (size_t i = count(); i < padded(); ++i) pixel[i] = -1;
}

}  // namespace edgepose
