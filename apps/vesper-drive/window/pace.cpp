#include "window/pace.h"

namespace vesper::drive {

void Pace::add(double seconds) {
    if (!begun_) {
        begun_ = true;
        return;
    }
    seconds_ += seconds, ++pictures_;
    if (seconds_ < kStretch) return;
    slow_ = double(pictures_) < kSlow * seconds_, crawls_ = double(pictures_) < kCrawl * seconds_;
    seconds_ = 0, pictures_ = 0;
}

std::optional<render::Quality> Pace::offer(render::Quality now) const {
    if (!slow_ || now == render::Quality::Fast) return std::nullopt;
    return render::Quality(unsigned(now) - 1);
}

}  // namespace vesper::drive
