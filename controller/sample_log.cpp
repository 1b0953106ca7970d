#include "controller/sample_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "common/error.h"
#include "common/output_target.h"

namespace edgepose {
namespace {

constexpr size_t kFlushBytes = 1 << 16;

void add(std::string& text, const char* format, ...) __attribute__((format(printf, 2, 3)));
void add(std::string& text, const char* format, ...) {
  char piece[64];
  va_list values;
  va_start(values, format);
  std::vsnprintf(piece, sizeof(piece), format, values);
  va_end(values);
  text += piece;
}

template <class Vector>
void add_all(std::string& text, const Vector& values) {
  for (const double value : values) add(text, ",%.9g", value);
}

std::string heading() {
  std::string text = "time_ns,state,phase,fault,goal_seen,standoff_m,tool_error_m,tool_angle_rad";
  const auto columns = [&](const char* name, int count) {
    for (int i = 1; i <= count; ++i) add(text, ",%s%d", name, i);
  };
  columns("feature", 6);
  columns("camera_velocity", 6);
  columns("measured_rad", kJoints);
  columns("commanded_rad", kJoints);
  columns("velocity_rad_s", kJoints);
  return text + ",condition,verdict\n";
}

}  // namespace

SampleLog::SampleLog(const std::filesystem::path& path) {
  const std::filesystem::path target = output_target(path);
  descriptor_ = open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    throw InputError::at(path.string(), "a file that can be written", std::strerror(errno));
  buffer_ = heading();
  lines_ = 1;
}

SampleLog::~SampleLog() {
  flush();
  close(descriptor_);
}

void SampleLog::write(const ControlSample& sample) {
  const ServoSample& s = sample.servo;
  add(buffer_, "%lld,%s", static_cast<long long>(sample.time_ns), state_name(s.state));
  add(buffer_, ",%s,%s,%d", name_of(sample.phase), fault_name(sample.fault), s.goal_seen ? 1 : 0);
  add(buffer_, ",%.9g,%.9g", s.standoff, s.tool_error.translation);
  add(buffer_, ",%.9g", s.tool_error.rotation);
  add_all(buffer_, s.features);
  add_all(buffer_, s.camera_twist);
  add_all(buffer_, s.measured);
  add_all(buffer_, s.command.position);
  add_all(buffer_, s.command.velocity);
  add(buffer_, ",%.6g,%s\n", s.condition, s.verdict ? verdict_name(*s.verdict) : "");
  ++lines_;
  if (buffer_.size() >= kFlushBytes) flush();
}

void SampleLog::flush() {
  size_t written = 0;
  while (written < buffer_.size()) {
    const ssize_t some = ::write(descriptor_, buffer_.data() + written, buffer_.size() - written);
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) break;
    written += static_cast<size_t>(some);
  }
  if (written == buffer_.size()) {
    file_bytes_ += static_cast<int64_t>(written);
  } else {
    // Half a block is taken back, so that the file ends with a whole line.
    if (ftruncate(descriptor_, file_bytes_) == 0) lseek(descriptor_, file_bytes_, SEEK_SET);
    lost_ += lines_;
  }
  buffer_.clear();
  lines_ = 0;
}

}  // namespace edgepose
