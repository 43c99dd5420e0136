# commands.rb FORMULA PREFIX: prints the shell commands by which a formula installs and tests a program below PREFIX, so that
# they can run where there is no Homebrew.
require "pathname"
require "shellwords"

PREFIX = Pathname(ARGV[1])

# What a formula may use of Homebrew.
class Formula
  class << self
    attr_reader :tested

    def method_missing(*) = (yield if block_given? && false)
    def respond_to_missing?(*) = true
    def test(&block) = @tested = block
  end

  def prefix = PREFIX
  def bin = PREFIX/"bin"
  def testpath = Pathname("/tmp/formula")
  def system(*words) = puts(words.map { |word| Shellwords.escape(word.to_s) }.join(" "))
  def assert_path_exists(path) = puts("test -s #{Shellwords.escape(path.to_s)}")
end

# The commands are those of Linux.
module OS
  def self.mac? = false
end

load ARGV[0]
formula = Corcast.new
formula.install
puts "(", "mkdir -p /tmp/formula", "cd /tmp/formula"
formula.instance_eval(&Corcast.tested)
puts ")"
