// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/portaudio.hpp"

#include "devices/audio/jack_watch.hpp"
#include "devices/audio/portaudio_session.hpp"
#include "devices/audio/quiet.hpp"
#include "devices/audio/stream_state.hpp"
#include "dsp/core/clock.hpp"
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

PaDeviceIndex default_input() {
    const PaHostApiIndex jack = Pa_HostApiTypeIdToHostApiIndex(paJACK);
    if (jack >= 0 && Pa_GetHostApiInfo(jack)->defaultInputDevice != paNoDevice)
        return Pa_GetHostApiInfo(jack)->defaultInputDevice;
    return Pa_GetDefaultInputDevice();
}

/// Directions that a run uses of a card.
struct Wanted {
    bool plays = true, hears = false;

    bool is_met_by(const PaDeviceInfo& info) const {
        return (!plays || info.maxOutputChannels > 0) && (!hears || info.maxInputChannels > 0);
    }
    const char* word() const { return !plays ? "input" : hears ? "card with outputs and inputs" : "output"; }
    const char* words() const { return !plays ? "inputs" : hears ? "cards with outputs and inputs" : "outputs"; }
};

/// The card of that name; without a name the default one.
PaDeviceIndex find_card(const std::string& name, const Wanted& wanted) {
    std::string others;
    const char* lacks = nullptr;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(i);
        const std::string full = audio_device_name(i);
        const bool is_named = !name.empty() && full.find(name) != std::string::npos;
        if (wanted.is_met_by(info)) {
            if (is_named) return i;
            others += fmt::format("{}'{}'", others.empty() ? "" : ", ", full);
        } else if (is_named) lacks = wanted.plays && info.maxOutputChannels == 0 ? "outputs" : "inputs";
    }
    if (lacks)
        throw Error(fmt::format("sound card '{}' has no {}; sound {} of this machine: {}", name, lacks, wanted.words(),
                                others.empty() ? "none" : others));
    if (others.empty()) throw Error(fmt::format("there is no sound {} on this machine", wanted.word()));
    if (!name.empty())
        throw Error(fmt::format("there is no sound {} '{}'; there are: {}", wanted.word(), name, others));
    const PaDeviceIndex output = default_output(), input = default_input();
    for (const PaDeviceIndex index : {wanted.plays ? output : input, wanted.plays ? input : output})
        if (index != paNoDevice && wanted.is_met_by(*Pa_GetDeviceInfo(index))) return index;
    throw Error(fmt::format("there is no default sound {}; choose one of: {}", wanted.word(), others));
}

/// The stream and all data of its callback. Outlives the sink when the card does not close.
struct OpenStream {
    OpenStream(int channels, std::size_t frames, std::size_t start) : state(channels, frames, start) {}

    PortAudioSession session;
    StreamState state;
    std::shared_ptr<InputRing> inputs;
    std::unique_ptr<JackWatch> jack;
    std::vector<float> unheard;  ///< of a card without outputs: what is played goes here, a piece at a time
    PaStream* stream = nullptr;
};

constexpr std::size_t max_unheard = 65536;  // frames in one callback of a card without outputs

/// In freewheel mode the server waits for its clients, so the callback waits for the engine's sound, up to a limit.
void wait_for_sound(const StreamState& state, unsigned long frames) {
    for (int i = 0; i < 5000 && !state.can_feed(frames); ++i) sleep_for(200'000);
}

int feed_card(const void* input, void* output, unsigned long frames, const PaStreamCallbackTimeInfo*,
              PaStreamCallbackFlags flags, void* opened) {
    auto& open = *static_cast<OpenStream*>(opened);
    const std::int64_t now = steady_ns();
    if (open.inputs)
        open.inputs->capture(static_cast<const float*>(input), frames, now,
                             (flags & (paInputOverflow | paInputUnderflow)) != 0);
    if (open.jack && open.jack->freewheels()) wait_for_sound(open.state, frames);
    if (!output) {
        if (frames <= max_unheard) open.state.feed(open.unheard.data(), frames, now);
        return paContinue;
    }
    open.state.feed(static_cast<float*>(output), frames, open.inputs ? now : steady_ns());
    return paContinue;
}

class PortAudioSink final : public AudioSink {
public:
    PortAudioSink(std::string device, double lead_s, HeardChannels heard)
        : device_(std::move(device)), lead_s_(lead_s), heard_(std::move(heard)) {}
    ~PortAudioSink() override { release(); }

    const std::string& name() const override { return name_; }

    void prepare(double rate, const std::vector<std::string>& channels) override {
        release();
        try {
            open(rate, static_cast<int>(channels.size()));
            if (open_->jack) open_->jack->name_ports("out", channels);
            if (open_->jack) open_->jack->name_ports("in", heard_.names);
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
        open_->inputs = heard_.ring;
        const int inputs = heard_.ring ? heard_.ring->channels() : 0;
        PaStreamParameters played{};
        played.device = find_card(device_, {heard_.is_played || inputs == 0, inputs > 0});
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(played.device);
        name_ = audio_device_name(played.device);
        const bool has_outputs = info.maxOutputChannels > 0;
        if (channels < 1 || (has_outputs && channels > info.maxOutputChannels))
            throw Error(
                fmt::format("'{}' has {} channels, but {} are needed", name_, info.maxOutputChannels, channels));
        if (inputs > info.maxInputChannels)
            throw Error(fmt::format("'{}' has {} inputs, but {} are needed", name_, info.maxInputChannels, inputs));
        if (!has_outputs) open_->unheard.resize(max_unheard * static_cast<std::size_t>(channels));
        if (info.hostApi == Pa_HostApiTypeIdToHostApiIndex(paJACK)) open_->jack = std::make_unique<JackWatch>();
        played.channelCount = channels;
        played.sampleFormat = paFloat32;
        played.suggestedLatency = info.defaultLowOutputLatency;
        const PaStreamParameters heard{played.device, inputs, paFloat32, info.defaultLowInputLatency, nullptr};
        PaError error = Pa_OpenStream(&open_->stream, inputs > 0 ? &heard : nullptr, has_outputs ? &played : nullptr,
                                      rate, paFramesPerBufferUnspecified, paNoFlag, feed_card, open_.get());
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
            sleep_for(10'000'000);
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
            if (opened->jack && opened->jack->is_gone())
                sleep_for(std::chrono::nanoseconds(std::chrono::hours(24 * 365)).count());
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
    HeardChannels heard_;
    std::shared_ptr<OpenStream> open_;
    AudioStatistics last_;
};

}  // namespace

std::vector<AudioCard> list_audio_cards() {
    const PortAudioSession session;
    const PaDeviceIndex preferred = default_output();
    std::vector<AudioCard> cards;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i)
        if (const PaDeviceInfo& info = *Pa_GetDeviceInfo(i); info.maxOutputChannels > 0 || info.maxInputChannels > 0)
            cards.push_back({audio_device_name(i), info.maxOutputChannels, info.maxInputChannels,
                             info.defaultSampleRate,
                             info.maxOutputChannels > 0 ? info.defaultLowOutputLatency : info.defaultLowInputLatency,
                             i == preferred});
    return cards;
}

std::unique_ptr<AudioSink> make_portaudio_sink(std::string device, double lead_s, HeardChannels heard) {
    return std::make_unique<PortAudioSink>(std::move(device), lead_s, std::move(heard));
}

}  // namespace tactus::audio
