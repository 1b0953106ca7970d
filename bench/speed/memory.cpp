#include "bench/speed/parts.h"
#include "evaluation/plot.h"
#include "evaluation/table.h"

namespace edgepose::bench {

std::string list_memory(SpeedRun& run) {
  Table table({"model", "diameter, mm", "points", "pairs", "memory, MB", "bytes a pair", "training, s"});
  for (size_t m = 0; m < run.models.size(); ++m) {
    const Model& model = run.models[m].model;
    const size_t bytes = model.block().size(), pairs = model.pair_count();
    table.add({harmless_text(run.set.objects[m].name), fixed(1e3 * model.diameter(), 1),
               count_text(model.point_count()), count_text(pairs),
               fixed(1e-6 * static_cast<double>(bytes), 2),
               fixed(pairs > 0 ? static_cast<double>(bytes) / static_cast<double>(pairs) : 0, 1),
               fixed(run.models[m].seconds, 2)});
  }
  return "## Memory of each model\n\n" + table.markdown() +
         "\nThe whole block, as it is in memory and in the model's file; 1 MB = 10^6 bytes.\n";
}

}  // namespace edgepose::bench
