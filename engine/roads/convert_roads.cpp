#include "roads/convert_roads.h"

#include "base/budget.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/in_file.h"
#include "roads/lit_roads.h"
#include "roads/opendrive.h"
#include "scene/gltf_save.h"

namespace vesper::roads {

RoadConversion convert_roads(const std::filesystem::path& opendrive, const std::filesystem::path& scene,
                             const ConvertOptions& options) {
    const io::FileGate gate;
    const Budget budget("converting " + one_line(opendrive.string()));
    LitRoadOptions lit{.lamps = options.lamps, .signals = options.signals, .signal_time = options.signal_time};
    if (!options.luminaire.empty()) lit.luminaire = photometry::read_distribution(options.luminaire);
    const RoadNetwork network = read_opendrive(opendrive);
    LitRoads roads = io::in_file(opendrive.string(), [&] { return lit_roads(network, lit); });
    if (lit.luminaire)
        for (const std::string& note : lit.luminaire->notes)
            roads.notes.push_back(one_line(options.luminaire.string()) + ": " + note);
    scene::save_gltf(roads.scene, opendrive.filename().string(), scene);
    return {std::move(roads.notes), network.notes};
}

}  // namespace vesper::roads
