// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/portaudio.hpp"

#include "devices/audio/jack_watch.hpp"
#include "devices/audio/portaudio_session.hpp"
#include "devices/audio/quiet.hpp"
#include "devices/audio/stream_state.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <portaudio.h>

#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <thread>

namespace tactus::audio {
namespace {

using namespace std::chrono_literals;

/// JACK's default output when JACK runs, because it then owns the card; otherwise the system's.
PaDeviceIndex default_output() {
    const PaHostApiIndex jack = Pa_HostApiTypeIdToHostApiIndex(paJACK);
    if (jack >= 0 && Pa_GetHostApiInfo(jack)->defaultOutputDevice != paNoDevice)
        return Pa_GetHostApiInfo(jack)->defaultOutputDevice;
    return Pa_GetDefaultOutputDevice();
}

PaDeviceIndex find_output(const std::string& wanted) {
    std::string names;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(i);
        if (info.maxOutputChannels == 0) continue;
        const std::string name = audio_device_name(i);
        if (!wanted.empty() && name.find(wanted) != std::string::npos) return i;
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name);
    }
    if (names.empty()) throw Error("there is no sound output on this machine");
    if (!wanted.empty()) throw Error(fmt::format("there is no sound output '{}'; there are: {}", wanted, names));
    const PaDeviceIndex index = default_output();
    if (index == paNoDevice) throw Error(fmt::format("there is no default sound output; choose one of: {}", names));
    return index;
}

/// The stream and all data of its callback. Outlives the sink when the card does not close.
struct OpenStream {
    OpenStream(int channels, std::size_t frames, std::size_t start) : state(channels, frames, start) {}

    PortAudioSession session;
    StreamState state;
    std::shared_ptr<InputRing> inputs;
    std::unique_ptr<JackWatch> jack;
    PaStream* stream = nullptr;
};

std::int64_t steady_now_ns() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// In freewheel mode the server waits for its clients, so the callback waits for the engine's sound, up to a limit.
void wait_for_sound(const StreamState& state, unsigned long frames) {
    for (int i = 0; i < 5000 && !state.can_feed(frames); ++i) std::this_thread::sleep_for(200us);
}

int feed_card(const void* input, void* output, unsigned long frames, const PaStreamCallbackTimeInfo*,
              PaStreamCallbackFlags flags, void* opened) {
    auto& open = *static_cast<OpenStream*>(opened);
    const std::int64_t now = steady_now_ns();
    if (open.inputs)
        open.inputs->capture(static_cast<const float*>(input), frames, now,
                             (flags & (paInputOverflow | paInputUnderflow)) != 0);
    if (open.jack && open.jack->freewheels()) wait_for_sound(open.state, frames);
    open.state.feed(static_cast<float*>(output), frames, open.inputs ? now : steady_now_ns());
    return paContinue;
}

class PortAudioSink final : public AudioSink {
public:
    PortAudioSink(std::string device, double lead_s, std::shared_ptr<InputRing> inputs,
                  std::vector<std::string> input_names)
        : device_(std::move(device)),
          lead_s_(lead_s),
          inputs_(std::move(inputs)),
          input_names_(std::move(input_names)) {}
    ~PortAudioSink() override { release(); }

    const std::string& name() const override { return name_; }

    void prepare(double rate, const std::vector<std::string>& channels) override {
        release();
        try {
            open(rate, static_cast<int>(channels.size()));
            if (open_->jack) open_->jack->name_ports("out", channels);
            if (open_->jack) open_->jack->name_ports("in", input_names_);
        } catch (...) {
            open_.reset();
            throw;
        }
    }

    std::size_t write(const float* interleaved, std::size_t frames) noexcept override {
        return open_ ? open_->state.write(interleaved, frames) : 0;
    }
    std::size_t writable() const noexcept override { return open_ ? open_->state.writable() : 0; }
    AudioStatistics statistics() const noexcept override { return open_ ? open_->state.statistics() : last_; }
    AudioProgress progress() const noexcept override {
        if (!open_) return {};
        AudioProgress progress = open_->state.progress();
        progress.waits = open_->jack && open_->jack->freewheels();
        return progress;
    }
    void leave_out(std::int64_t frames) noexcept override {
        if (open_) open_->state.leave_out(frames);
    }
    void close() override { release(); }

private:
    void open(double rate, int channels) {
        const QuietStderr quiet;
        const auto start = static_cast<std::size_t>(std::lround(lead_s_ * rate));
        // Capacity for short stalls of the card or the engine, and for the largest buffers of cards.
        open_ = std::make_shared<OpenStream>(channels, 4 * start + 16384, start);
        open_->inputs = inputs_;
        PaStreamParameters parameters{};
        parameters.device = find_output(device_);
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(parameters.device);
        name_ = audio_device_name(parameters.device);
        if (channels < 1 || channels > info.maxOutputChannels)
            throw Error(
                fmt::format("'{}' has {} channels, but {} are needed", name_, info.maxOutputChannels, channels));
        const int inputs = inputs_ ? inputs_->channels() : 0;
        if (inputs > info.maxInputChannels)
            throw Error(fmt::format("'{}' has {} inputs, but {} are needed", name_, info.maxInputChannels, inputs));
        if (info.hostApi == Pa_HostApiTypeIdToHostApiIndex(paJACK)) open_->jack = std::make_unique<JackWatch>();
        parameters.channelCount = channels;
        parameters.sampleFormat = paFloat32;
        parameters.suggestedLatency = info.defaultLowOutputLatency;
        const PaStreamParameters heard{parameters.device, inputs, paFloat32, info.defaultLowInputLatency, nullptr};
        PaError error = Pa_OpenStream(&open_->stream, inputs > 0 ? &heard : nullptr, &parameters, rate,
                                      paFramesPerBufferUnspecified, paNoFlag, feed_card, open_.get());
        if (error == paNoError) error = Pa_StartStream(open_->stream);
        if (error == paNoError) return;
        if (open_->stream != nullptr) Pa_CloseStream(open_->stream);
        throw Error(fmt::format("'{}' cannot play {} channels{} at {:g} Hz: {}; it prefers {:g} Hz", name_, channels,
                                inputs > 0 ? fmt::format(" and hear {}", inputs) : "", rate, Pa_GetErrorText(error),
                                info.defaultSampleRate));
    }

    /// Waits until everything is played, or the card stops calling.
    void play_out() const {
        open_->state.end();
        std::int64_t frames = open_->state.progress().frames;
        for (int idle = 0; idle < 50 && !open_->state.is_empty();) {
            std::this_thread::sleep_for(10ms);
            const std::int64_t now = open_->state.progress().frames;
            idle = now == frames ? idle + 1 : 0;
            frames = now;
        }
    }

    /// Stopping a stream whose server died blocks forever. A detached thread does it and owns all data of the stream;
    /// the caller waits only as long as a working card needs.
    void release() {
        if (!open_) return;
        play_out();
        last_ = open_->state.statistics();
        std::promise<void> done;
        std::future<void> closed = done.get_future();
        std::thread([opened = std::move(open_), promise = std::move(done)]() mutable {
            if (opened->jack && opened->jack->is_gone()) std::this_thread::sleep_for(std::chrono::hours(24 * 365));
            Pa_StopStream(opened->stream);
            Pa_CloseStream(opened->stream);
            opened.reset();
            promise.set_value();
        }).detach();
        const QuietStderr quiet;
        closed.wait_for(2s);
    }

    std::string device_, name_ = "sound card";
    double lead_s_;
    std::shared_ptr<InputRing> inputs_;
    std::vector<std::string> input_names_;
    std::shared_ptr<OpenStream> open_;
    AudioStatistics last_;
};

}  // namespace

std::vector<AudioOutput> list_audio_outputs() {
    const PortAudioSession session;
    const PaDeviceIndex preferred = default_output();
    std::vector<AudioOutput> outputs;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i)
        if (const PaDeviceInfo& info = *Pa_GetDeviceInfo(i); info.maxOutputChannels > 0)
            outputs.push_back({audio_device_name(i), info.maxOutputChannels, info.defaultSampleRate,
                               info.defaultLowOutputLatency, i == preferred});
    return outputs;
}

std::unique_ptr<AudioSink> make_portaudio_sink(std::string device, double lead_s, std::shared_ptr<InputRing> inputs,
                                               std::vector<std::string> input_names) {
    return std::make_unique<PortAudioSink>(std::move(device), lead_s, std::move(inputs), std::move(input_names));
}

}  // namespace tactus::audio
