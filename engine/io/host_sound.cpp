// SPDX-License-Identifier: Apache-2.0
// Which card and channel a node plays on.
#include "devices/audio/portaudio.hpp"
#include "engine/io/host.hpp"
#include "graph/compile/sounds.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::io {

namespace {

bool has_outputs(const std::string& card) {
    return std::ranges::any_of(audio::list_audio_cards(),
                               [&](const audio::AudioCard& one) { return one.name == card && one.outputs > 0; });
}

}  // namespace

bool EngineHost::is_in_use(const SoundCard& card, int channel) const {
    return std::ranges::any_of(sounds_in_use_, [&](const SoundChannel* sound) {
        return &sound->card() == &card && sound->index() == channel;
    });
}

std::unique_ptr<SoundCard> EngineHost::make_card(Flicks period, const SoundPlace& place) const {
    const std::string chosen = audio_.device == "default" ? "" : audio_.device;
    CardUse use{period, audio_.margin_s, group_, place.card, place.channel > 0, place.max_frames};
    std::shared_ptr<audio::InputRing> inputs;
    std::vector<std::string> input_names;
    if (const auto names = channel_names_.find(place.card); use.is_shared && names != channel_names_.end()) {
        input_names = names->second.inputs;
        use.is_played = !names->second.outputs.empty();
    }
    if (!input_names.empty())
        // Over a second, many of the largest callbacks, and what waits on purpose.
        inputs = std::make_shared<audio::InputRing>(
            static_cast<int>(input_names.size()),
            65536 + static_cast<std::size_t>(4.0 * audio_.margin_s * rate_of(period)));
    auto sink = audio::make_portaudio_sink(place.card.empty() ? chosen : place.card, audio_.margin_s,
                                           {inputs, std::move(input_names), use.is_played});
    return std::make_unique<SoundCard>(std::move(sink), std::move(use), std::move(inputs));
}

SoundCard& EngineHost::open_card(std::unique_ptr<SoundCard> card, const std::vector<std::string>& names) {
    card->open(names);
    opened_.notices.push_back(fmt::format("{} {}",
                                          !card->use().is_played ? "hearing"
                                          : card->inputs() > 0   ? "playing on and hearing"
                                                                 : "playing on",
                                          card->name()));
    return *opened_.cards.emplace_back(std::move(card));
}

SoundChannel& EngineHost::own_channel(const StreamFormat& format, const SoundPlace& place) {
    // A card whose node an edit took away plays on, and only one thread ever writes to it.
    for (const auto& card : cards) {
        const CardUse& use = card->use();
        if (!card->is_lost() && !use.is_shared && use.group == group_ && use.period == format.period &&
            use.wanted == place.card && !is_in_use(*card, 0))
            return card->channel(0);
    }
    return open_card(make_card(format.period, place), {place.name}).channel(0);
}

SoundCard& EngineHost::shared_card(Flicks period, const SoundPlace& place) {
    for (const auto* list : {&cards, &opened_.cards})
        for (const auto& card : *list) {
            const CardUse& use = card->use();
            if (!card->is_lost() && use.is_shared && use.wanted == place.card && use.group == group_) return *card;
        }
    const auto names = channel_names_.find(place.card);
    std::vector<std::string> outputs;
    if (names != channel_names_.end()) outputs = names->second.outputs;
    if (outputs.empty()) outputs.resize(1);
    return open_card(make_card(period, place), outputs);
}

SoundChannel& EngineHost::shared_channel(const StreamFormat& format, const SoundPlace& place) {
    SoundCard& card = shared_card(format.period, place);
    if (!card.use().is_played && !has_outputs(card.name()))
        throw Error(place.where,
                    fmt::format("{} has no outputs, and is heard in this run; a node that plays takes effect "
                                "at the next start, with another card",
                                card.name()));
    if (place.channel > card.channels())
        throw Error(place.where,
                    fmt::format("{} plays {} channels in this run; channel {} takes effect at the next start",
                                card.name(), card.channels(), place.channel));
    return card.channel(place.channel - 1);
}

void EngineHost::choose_source(SoundHeard& made, const SoundPlace& place, Flicks period,
                               std::optional<std::vector<float>> instead) {
    // In a replay, the input comes from the log.
    if (recorded_ || hears_from_log_ || describes_hardware_) return;
    const bool has_card = live_ && audio_.device != "file" && audio_.device != "none";
    if (!has_card && !instead)
        throw Error(place.where,
                    fmt::format("node '{}' reads from a sound card, {}; give it a sound of [assets] instead: file = "
                                "\"NAME\"",
                                place.name, live_ ? "and --audio names none" : "which only 'tactus run' has"));
    if (has_card) try {
            SoundCard& card = shared_card(period, place);
            if (place.channel > card.inputs())
                throw Error(place.where,
                            fmt::format("{} reads {} channels in this run; channel {} takes effect at the next start",
                                        card.name(), card.inputs(), place.channel));
            made.card = &card;
            made.channel = place.channel - 1;
            return;
        } catch (const Error& error) {
            if (!instead || audio_.is_required() || !error.where().file.empty())
                throw Error(place.where, fmt::format("node '{}' has nothing to hear: {}", place.name, error.message()));
            opened_.notices.push_back(
                fmt::format("no sound card ({}); node '{}' reads its file", error.message(), place.name));
        }
    made.file = std::move(*instead);
}

const SoundInPort& EngineHost::listen(const SoundPlace& place, Flicks period,
                                      std::optional<std::vector<float>> instead) {
    auto made = std::make_unique<SoundHeard>();
    made->port.samples.resize(static_cast<std::size_t>(place.max_frames));
    made->group = group_;
    for (const auto* list : {&heard, &opened_.heard})
        for (const auto& other : *list) made->id += other->group == group_;
    choose_source(*made, place, period, std::move(instead));
    uses_->heard.push_back(opened_.heard.emplace_back(std::move(made)).get());
    return uses_->heard.back()->port;
}

void EngineHost::expect_sounds(const compile::Schedule& plan) {
    channel_names_.clear();
    const auto note = [](std::vector<std::string>& names, int channel, const std::string& name) {
        const auto index = static_cast<std::size_t>(channel - 1);
        if (index >= names.size()) names.resize(index + 1);
        names[index] = name;
    };
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (const std::optional<compile::SoundTarget> target = compile::sound_target(node))
            note(channel_names_[target->card].outputs, target->channel, node.name);
        if (const std::optional<compile::SoundTarget> source = compile::sound_source(node))
            note(channel_names_[source->card].inputs, source->channel, node.name);
    }
}

RecordStream& EngineHost::audio(const StreamFormat& format, const SoundPlace& place) {
    if (!live_ || audio_.device == "file") return record(format, place.where);
    if (audio_.device == "none") {
        StreamFormat unheard = format;
        unheard.file.clear();
        opened_.streams.push_back(std::make_unique<Stream>(unheard, make_null_sink()));
        uses_->streams.push_back(opened_.streams.back().get());
        return *opened_.streams.back();
    }
    try {
        SoundChannel& channel = place.channel > 0 ? shared_channel(format, place) : own_channel(format, place);
        if (std::ranges::find(opened_.cards, &channel.card(), &std::unique_ptr<SoundCard>::get) != opened_.cards.end())
            channel.card().expect(channel.index());
        sounds_in_use_.push_back(&channel);
        uses_->sounds.push_back(&channel);
        return channel;
    } catch (const Error& error) {
        if (audio_.is_required() || !error.where().file.empty()) throw Error(place.where, error.message());
        opened_.notices.push_back(
            fmt::format("no sound card ({}); the sound goes to {}", error.message(), format.file));
    }
    return record(format, place.where);
}

}  // namespace tactus::io
