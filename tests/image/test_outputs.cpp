// Files that are whole or absent, NumPy headers, PNGs.
#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "commands/image_file.hpp"
#include "commands/npy.hpp"
#include "commands/output.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace app;

TEST(Output, AppearsWholeOnCommitOnly) {
  const TemporaryFolder folder;
  Outputs outputs;
  folder.write("result", "old");
  auto file = outputs.open(folder.file("result"));
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_TRUE(file->write("new"));
  EXPECT_EQ(read_all(folder.file("result")), "old");
  EXPECT_EQ(folder.names().size(), 2u);
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(read_all(folder.file("result")), "new");
  EXPECT_EQ(folder.names(), std::set<std::string>{"result"});
}

TEST(Output, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  Outputs outputs;
  {
    auto file = outputs.open(folder.file("result"));
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write("half"));
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(Output, SaysWhatCannotBeWritten) {
  const TemporaryFolder folder;
  Outputs outputs;
  const auto missing = outputs.open(folder.file("no/such/file"));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no/such/file"), std::string::npos);
  EXPECT_FALSE(outputs.open(folder.path()));
  const auto full = write_text(outputs, "/dev/full", std::string(1 << 16, 'x'));
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().message.find("/dev/full"), std::string::npos);
}

TEST(Output, KeepsLinksAndDevices) {
  const TemporaryFolder folder;
  Outputs outputs;
  folder.write("target", "old");
  std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
  ASSERT_TRUE(write_text(outputs, folder.file("link"), "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(read_all(folder.file("target")), "new");
  ASSERT_TRUE(write_text(outputs, "/dev/null", "gone"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(Output, AnInterruptRemovesWhatIsHalfWritten) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) {
      Outputs outputs;
      auto file = outputs.open(folder.file("result"));
      if (!file || !file->write("half")) _exit(9);
      kill(getpid(), signal_number);
      for (;;) pause();
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal_number) << status;
    EXPECT_TRUE(folder.names().empty());
  }
}

TEST(Npy, HeaderIsWhatNumpyReads) {
  const uint64_t shape[] = {3, 720, 1280};
  const std::string header = npy_header(NpyType::uint8, shape);
  EXPECT_EQ(header.size() % 64, 0u);
  EXPECT_EQ(header.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const size_t length = static_cast<uint8_t>(header[8]) + 256u * static_cast<uint8_t>(header[9]);
  EXPECT_EQ(length + 10, header.size());
  EXPECT_EQ(header.back(), '\n');
  EXPECT_NE(header.find("{'descr': '|u1', 'fortran_order': False, 'shape': (3, 720, 1280), }"), std::string::npos);
  const uint64_t one[] = {5};
  EXPECT_NE(npy_header(NpyType::float32, one).find("'<f4', 'fortran_order': False, 'shape': (5, ), }"),
            std::string::npos);
}

TEST(Npy, WritesPieceByPiece) {
  const TemporaryFolder folder;
  Outputs outputs;
  const uint64_t shape[] = {2, 3};
  auto writer = NpyWriter::create(outputs, folder.file("a.npy"), NpyType::float32, shape);
  ASSERT_TRUE(writer);
  const float values[] = {1, 2, 3, 4, 5, 6};
  ASSERT_TRUE(writer->append(std::span(values, 2)));
  ASSERT_TRUE(writer->append(std::span(values + 2, 4)));
  ASSERT_TRUE(writer->commit());
  const std::string text = read_all(folder.file("a.npy"));
  ASSERT_EQ(text.size(), npy_header(NpyType::float32, shape).size() + sizeof values);
  EXPECT_EQ(std::memcmp(text.data() + text.size() - sizeof values, values, sizeof values), 0);
}

TEST(Png, ReadsBackAsWritten) {
  const TemporaryFolder folder;
  Outputs outputs;
  const uint32_t width = 37, height = 11;
  std::vector<uint8_t> rgba(width * height * 4);
  for (size_t i = 0; i < rgba.size(); ++i) rgba[i] = static_cast<uint8_t>(i * 31);
  ASSERT_TRUE(write_png(outputs, folder.file("a.png"), width, height, rgba));
  int read_width = 0, read_height = 0, channels = 0;
  stbi_uc* pixels = stbi_load(folder.file("a.png").c_str(), &read_width, &read_height, &channels, 3);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(read_width, 37);
  EXPECT_EQ(read_height, 11);
  EXPECT_EQ(channels, 3);
  for (size_t i = 0; i < size_t(width) * height; ++i)
    for (size_t c = 0; c < 3; ++c) ASSERT_EQ(pixels[3 * i + c], rgba[4 * i + c]) << i;
  stbi_image_free(pixels);
}

}  // namespace
