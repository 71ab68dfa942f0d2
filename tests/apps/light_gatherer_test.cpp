// Light between surfaces beside a drive: a stand-in, then what pictures have. SPDX-License-Identifier: MIT
#include "session/light_gatherer.h"

#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "scene/placement.h"
#include "support/rooms.h"
#include "support/shelf.h"
#include "transport/kept_radiosity.h"

namespace vesper::test::light_gatherer_test {
namespace {

using drive::LightGatherer, transport::Radiosity;

// Takes what was found before the first that is kept.
struct TakingShelf : Shelf {
    std::promise<LightGatherer*> gatherer;
    std::shared_ptr<const Radiosity> before;

    void write(const Digest::Value& key, std::span<const std::byte> bytes) override {
        if (kept.empty()) before = gatherer.get_future().get()->take();
        Shelf::write(key, bytes);
    }
};

void wait_for(const LightGatherer& gatherer) {
    while (!gatherer.done()) std::this_thread::yield();
}

TEST(LightGatherer, GivesAStandInAndThenTheWhole) {
    const scene::Scene scene = lit_room();
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const auto shelf = std::make_shared<TakingShelf>();
    LightGatherer gatherer(scene, world, {}, shelf);
    shelf->gatherer.set_value(&gatherer);
    wait_for(gatherer);
    const auto whole = gatherer.take();
    ASSERT_TRUE(shelf->before && whole);
    EXPECT_EQ(shelf->before->grid.size, 2);
    EXPECT_GT(shelf->before->cells(), 0u);
    EXPECT_FALSE(gatherer.take()) << "nothing new";
    EXPECT_EQ(gatherer.problem(), "");

    Shelf other;
    const auto expected = transport::kept_or_gathered(scene, world, {}, {}, &other, {});
    EXPECT_EQ(whole->numbers, expected->numbers);
    EXPECT_EQ(whole->met, expected->met);
    EXPECT_EQ(whole->solve({}).other, expected->solve({}).other);
    EXPECT_EQ(shelf->kept, other.kept) << "under the same key";
}

TEST(LightGatherer, TakesTheWholeFromACache) {
    const scene::Scene scene = lit_room();
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const auto shelf = std::make_shared<Shelf>();
    const auto expected = transport::kept_or_gathered(scene, world, {}, {}, shelf.get(), {});
    LightGatherer gatherer(scene, world, {}, shelf);
    wait_for(gatherer);
    EXPECT_EQ(gatherer.share(), 0) << "without work";
    const auto whole = gatherer.take();
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->met, expected->met);
}

TEST(LightGatherer, NeedsNoCache) {
    const scene::Scene scene = lit_room();
    for (const bool full : {false, true}) {
        const auto shelf = full ? std::make_shared<Shelf>() : nullptr;
        if (full) shelf->full = true;
        LightGatherer gatherer(scene, scene::world_transforms(scene, 0), {}, shelf);
        wait_for(gatherer);
        const auto whole = gatherer.take();
        ASSERT_TRUE(whole);
        EXPECT_EQ(whole->grid.size, 0.125);
        EXPECT_GT(gatherer.share(), 0.5);
    }
}

}  // namespace
}  // namespace vesper::test::light_gatherer_test
