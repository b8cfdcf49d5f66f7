#include "refine/tile_helper.h"

#include <optional>
#include <string>

#include "core/error.h"
#include "projtex/photograph_file.h"
#include "refine/ray_tasks.h"
#include "refine/tile_tasks.h"

namespace photohull::refine {

namespace fs = std::filesystem;

class TileHelper::Work {
 public:
  Work(gpu::Context& context, const fs::path& folder) : context_(context), folder_(folder) {}

  bool help() {
    return folder_.help([this](const std::string& task) { return perform(task); });
  }

 private:
  std::string perform(const std::string& task) {
    ListReader reader(task);
    const TaskHead head = TaskHead::read(reader);
    const std::string& device = context_.device().renderer;
    if (head.device != device)
      throw Error(concat("the work was begun on ", head.device, ", and results by ", device,
                         " would be rounded in another way"));
    if (head.kind == TaskKind::kRays) return perform_rays(head, read_ray_task(reader));
    const MatchingPhotographs photographs(photographs_of(head));
    return perform_tile(context_, photographs, head.kind, reader);
  }

  std::string perform_rays(const TaskHead& head, const RayTask& task) {
    if (!searched_ || searched_->name != task.space) {
      searched_.reset();
      projtex::OutOfCorePhotographs& some = photographs_of(head);
      // All of them are held, in their order.
      const projtex::HeldPhotographs& held = some.hold({});
      searched_.emplace();
      searched_->name = task.space;
      RaySpace& space = searched_->space;
      space = read_ray_space(folder_.folder() / task.space);
      searched_->map_of =
          ray_mapper(context_, space.hull, space.surface ? &*space.surface : nullptr,
                     {held.images, held.cameras, some.noise_sigma()}, space.options);
    }
    return bytes_of(searched_->map_of(task.view));
  }

  /// Of the task's job, from its file when they are asked for first.
  projtex::OutOfCorePhotographs& photographs_of(const TaskHead& head) {
    const fs::path file = photograph_file(folder_.folder(), head.job, head.larger != 0);
    Opened& opened = head.larger != 0 ? larger_ : photographs_;
    if (!opened.photographs || opened.file != file) {
      searched_.reset();
      opened = {};
      opened = {file, projtex::open_photographs(file)};
    }
    return *opened.photographs;
  }

  struct Opened {
    fs::path file;
    std::unique_ptr<projtex::OutOfCorePhotographs> photographs;
  };
  struct Searched {
    std::string name;
    RaySpace space;
    ViewMapper map_of;
  };

  gpu::Context& context_;
  share::TaskFolder folder_;
  Opened photographs_, larger_;
  std::optional<Searched> searched_;
};

bool has_tiles(const fs::path& folder) { return share::has_tasks(folder); }

TileHelper::TileHelper(gpu::Context& context, const fs::path& folder)
    : work_(std::make_unique<Work>(context, folder)) {}
TileHelper::~TileHelper() = default;

bool TileHelper::help() { return work_->help(); }

}  // namespace photohull::refine
