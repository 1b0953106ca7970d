#pragma once
#include "evaluation/score.h"

namespace edgepose {

/// Two objects of diameter 0.1 m in two images, made in memory: image 0 shows both, image 1 only object 1.
/// Object 2 is symmetric. No files.
inline TestSet tiny_set() {
  TestSet set;
  set.name = "tiny";
  set.objects.resize(2);
  set.objects[0].id = 1;
  set.objects[0].name = "plain";
  set.objects[1].id = 2;
  set.objects[1].name = "round";
  set.objects[1].symmetric = true;
  for (TestObject& object : set.objects) object.diameter = 0.1;
  set.images.resize(2);
  GroundTruth truth;
  truth.visible_pixels = 1000;
  truth.camera_T_model.translation() = Eigen::Vector3d(0, 0, 1);
  for (int i = 0; i < 2; ++i) {
    set.images[static_cast<size_t>(i)].scene_id = 1;
    set.images[static_cast<size_t>(i)].image_id = i;
    truth.object_id = 1;
    set.images[static_cast<size_t>(i)].truth.push_back(truth);
  }
  truth.object_id = 2;
  set.images[0].truth.push_back(truth);
  return set;
}

inline PoseErrors tiny_errors() {
  Mesh mesh;
  mesh.vertices = {{0.05f, 0, 0}, {-0.05f, 0, 0}, {0, 0.02f, 0}};
  PoseErrors errors;
  errors.emplace(1, PoseError(mesh, false));
  errors.emplace(2, PoseError(mesh, true));
  return errors;
}

/// An answer that is `metres` beside the truth of tiny_set().
inline EvalRow answer(int image, int object, double metres, double score = 0.9, bool accepted = true) {
  EvalRow row;
  row.scene_id = 1;
  row.image_id = image;
  row.object_id = object;
  row.found = true;
  row.accepted = accepted;
  row.score = score;
  row.camera_T_model.translation() = Eigen::Vector3d(metres, 0, 1);
  row.seconds = 0.1;
  return row;
}

}  // namespace edgepose
