// URIs that hold their bytes themselves. SPDX-License-Identifier: MIT
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

std::string decoded(const std::string& uri) {
    const std::vector<uint8_t> bytes = scene::decode_data_uri(uri);
    return {bytes.begin(), bytes.end()};
}

TEST(DataUri, CaseOfSchemeAndMarkDoesNotMatter) {
    for (const char* uri : {"data:;base64,SGk=", "DATA:;base64,SGk=", "Data:text/plain;BASE64,SGk",
                            "data:text/plain;charset=utf-8;Base64,SGk%3D", "data:,Hi", "daTA:text/plain,%48i"}) {
        EXPECT_TRUE(scene::is_data_uri(uri)) << uri;
        EXPECT_EQ(decoded(uri), "Hi") << uri;
    }
    for (const char* uri : {"", "data", "dat:,Hi", "xdata:,Hi"}) EXPECT_FALSE(scene::is_data_uri(uri)) << uri;
}

TEST(DataUri, WhatIsWrongIsCalledByItsName) {
    const auto complaint = [](const std::string& uri) { return complaint_of([&] { scene::decode_data_uri(uri); }); };
    EXPECT_TRUE(contains(complaint("data:;base64,SG\nk="), "contains a line break"));
    EXPECT_TRUE(contains(complaint("data:;base64,SGkh\r\nSGkh"), "contains a line break"));
    EXPECT_TRUE(contains(complaint("data:;base64,SG k="), "contains a space"));
    EXPECT_TRUE(contains(complaint("data:;base64,SG*"), "contains a character that is none of its digits"));
    EXPECT_TRUE(contains(complaint("data:;base64,SGkhS"), "is cut off"));
    EXPECT_TRUE(contains(complaint("data:text/plain"), "without a comma"));
}

// What a URI holds is in no message, whatever is wrong with it.
TEST(DataUri, PayloadsAreNotPrinted) {
    const std::string payload(4000, 'Q');
    for (const std::string& uri :
         {"DATA:application/octet-stream;base64," + payload + "*", "data:" + payload, "dato:;base64," + payload,
          "data:x/" + payload + ",", "data:image/png;base64," + payload}) {
        GltfFile file;
        file.root["buffers"] = {{{"byteLength", 3}, {"uri", uri}}};
        const std::string refused = file.complaint();
        EXPECT_FALSE(contains(refused, std::string(100, 'Q'))) << refused;
        file.root.erase("buffers");
        file.root["images"] = {{{"uri", uri}}};
        for (const std::string& note : file.read().notes) EXPECT_FALSE(contains(note, std::string(100, 'Q'))) << note;
    }
}

}  // namespace
}  // namespace vesper::test
