// The memory of an eye through the C interface. SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "support/c_interface.h"

namespace vesper::test {
namespace {

TEST_F(CInterface, WhatTheEyeRemembersCanBeKept) {
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK);
    std::vector<float> dark(3 * 64, 0.1f), bright(3 * 64, 1000.0f);
    std::vector<uint8_t> codes(4 * 64);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data();
    const auto show = [&](const std::vector<float>& rgb, float seconds) {
        const VesperPicture picture = picture_of(rgb, 8, 8);
        EXPECT_EQ(vesper_tone_map(mapper, nullptr, &picture, seconds, &outputs, &error), VESPER_OK) << error.message;
        return codes;
    };
    show(dark, 0);
    std::vector<unsigned char> eye(vesper_eye_size());
    ASSERT_EQ(vesper_tone_mapper_eye(mapper, eye.data(), &error), VESPER_OK);
    const auto dazzled = show(bright, 0.05f);
    show(bright, 10);
    const auto settled = show(bright, 10);
    ASSERT_EQ(vesper_tone_mapper_set_eye(mapper, eye.data(), eye.size(), &error), VESPER_OK);
    EXPECT_EQ(show(bright, 0.05f), dazzled);
    EXPECT_NE(dazzled, settled);
    EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, eye.data(), 3, &error), VESPER_BAD_ARGUMENT);
    ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
    show(bright, 0);
    vesper_tone_mapper_destroy(mapper);
}

// The sum over an eye, as its bytes have it: FNV-1a of the version and what follows the three words of the head.
void sum(std::vector<unsigned char>& eye) {
    std::vector<unsigned char> summed(12);
    const uint32_t version[]{VESPER_VERSION_MAJOR, VESPER_VERSION_MINOR, VESPER_VERSION_PATCH};
    std::memcpy(summed.data(), version, 12);
    summed.insert(summed.end(), eye.begin() + 12, eye.end());
    uint32_t hash = 0x811c9dc5;
    for (const unsigned char byte : summed) hash = (hash ^ byte) * 0x01000193;
    std::memcpy(eye.data() + 8, &hash, sizeof hash);
}

TEST_F(CInterface, NoEyeRemembersAnything) {
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK);
    std::vector<unsigned char> eye(vesper_eye_size());
    // Of any age that one can come to: a million seconds for each of a million pictures.
    ASSERT_EQ(vesper_tone_mapper_eye(mapper, eye.data(), &error), VESPER_OK);
    for (const auto& [age, result] : {std::pair{1e12f, VESPER_OK},
                                      {2e12f, VESPER_BAD_ARGUMENT},
                                      {-1.0f, VESPER_BAD_ARGUMENT},
                                      {NAN, VESPER_BAD_ARGUMENT}}) {
        std::vector<unsigned char> aged = eye;
        std::memcpy(aged.data() + 3 * sizeof(uint32_t) + sizeof(float), &age, sizeof age);
        sum(aged);
        EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, aged.data(), aged.size(), &error), result) << age;
    }
    ASSERT_EQ(vesper_tone_mapper_eye(mapper, eye.data(), &error), VESPER_OK);
    for (const float poison : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::max()})
        for (const size_t place : {size_t(12), eye.size() - 4}) {
            std::vector<unsigned char> bytes = eye;
            std::memcpy(&bytes[place], &poison, sizeof poison);
            sum(bytes);
            EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, bytes.data(), bytes.size(), &error), VESPER_BAD_ARGUMENT)
                << poison << " at " << place;
        }
    EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, eye.data(), eye.size(), &error), VESPER_OK);
    EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, eye.data(), eye.size() - 4, &error), VESPER_BAD_ARGUMENT);
    // Of something else, of another version, or damaged anywhere.
    for (size_t place = 0; place < eye.size(); ++place) {
        std::vector<unsigned char> bytes = eye;
        bytes[place] ^= 1 << place % 8;
        EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, bytes.data(), bytes.size(), &error), VESPER_BAD_ARGUMENT) << place;
    }
    vesper_tone_mapper_destroy(mapper);
}

}  // namespace
}  // namespace vesper::test
