# A formula for a tap. `make packages` prints the hash of the release.
class Corcast < Formula
  desc "Grows, draws, exports and checks arterial trees"
  homepage "https://github.com/corcast/corcast"
  url "https://github.com/corcast/corcast/releases/download/v0.1.0/corcast-0.1.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "MIT"

  depends_on "pkg-config" => :build
  depends_on "cairo"
  depends_on "freetype"
  depends_on "imath"
  depends_on "isa-l"
  depends_on "jansson"
  depends_on "jpeg-turbo"
  depends_on "libdeflate"
  depends_on "libmd"
  depends_on "libpng"
  depends_on "libtiff"
  depends_on "little-cms2"
  depends_on "lz4"
  depends_on "nifti_clib"
  depends_on "openexr"
  depends_on "sdl2"
  depends_on "webp"
  uses_from_macos "expat"
  uses_from_macos "zlib"

  on_macos do
    depends_on "make" => :build # the Makefile needs GNU make 4
  end

  def install
    make = OS.mac? ? "gmake" : "make"
    system make, "all", "lib", "PREFIX=#{prefix}"
    system make, "install", "PREFIX=#{prefix}"
  end

  test do
    system bin/"corcast", "grow", "--terminals", "50", "--seed", "4", "-o", "tree.swc"
    system bin/"corcast", "render", "tree.swc", "--size", "80x60", "-o", "tree.png"
    assert_path_exists testpath/"tree.png"
  end
end
