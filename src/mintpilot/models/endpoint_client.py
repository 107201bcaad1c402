"""One call to an OpenAI-compatible server through `pydantic-ai`. Imported only where a server is configured."""

from __future__ import annotations

import json
from dataclasses import dataclass

import httpx2
from openai import AsyncOpenAI
from pydantic import BaseModel
from pydantic_ai.direct import model_request
from pydantic_ai.exceptions import ModelAPIError, ModelHTTPError, UnexpectedModelBehavior
from pydantic_ai.messages import BinaryContent, ModelRequest, UserPromptPart
from pydantic_ai.models import ModelRequestParameters
from pydantic_ai.models.openai import OpenAIChatModel
from pydantic_ai.output import OutputObjectDefinition
from pydantic_ai.profiles.openai import OpenAIModelProfile
from pydantic_ai.providers.openai import OpenAIProvider
from pydantic_ai.settings import ModelSettings

from mintpilot.core.errors import DeviceError

MOST_BYTES = 1_000_000
_KEPT_HEADERS = ("host", "content-type", "content-length", "accept", "connection", "user-agent")
_JSON = {"content-type": "application/json"}
_NO_KEY = "none"
_REFUSALS = (400, 404, 415, 422, 501)


@dataclass(frozen=True, kw_only=True, repr=False)
class Call:
    """What is asked, of whom. It is never printed: it holds the key."""

    url: str
    model: str
    key: str
    prompt: str
    form: type[BaseModel] | None
    """For JSON by ``response_format``."""
    most_tokens: int
    """Longest answer."""
    picture_png: bytes | None = None
    """A picture that goes with the prompt."""


class _TooLongError(Exception):
    """The server sent more than `MOST_BYTES`."""


class _Bounded(httpx2.AsyncBaseTransport):
    """Counts what a server sends, and strips what the client adds of its own accord.

    The client would send along an organisation and a project from the environment, and facts on this machine.
    """

    def __init__(self, key: str) -> None:
        self._inner = httpx2.AsyncHTTPTransport(retries=0)
        self._key = key

    async def handle_async_request(self, request: httpx2.Request) -> httpx2.Response:
        kept = [(name, value) for name, value in request.headers.items() if name.lower() in _KEPT_HEADERS]
        own = [("Authorization", f"Bearer {self._key}")] if self._key else []
        request.headers = httpx2.Headers([*kept, *own, ("accept-encoding", "identity")])
        response = await self._inner.handle_async_request(request)
        body = bytearray()
        async for chunk in response.aiter_raw():
            body += chunk
            if len(body) > MOST_BYTES:
                raise _TooLongError
        await response.aclose()
        return httpx2.Response(response.status_code, headers=_JSON, content=_completed(bytes(body)))

    async def aclose(self) -> None:
        await self._inner.aclose()


def _completed(body: bytes) -> bytes:
    """The answer with the fields that the client insists on and that lean servers leave out."""
    try:
        reply = json.loads(body)
        for index, choice in enumerate(reply["choices"]):
            choice.setdefault("index", index)
            choice.setdefault("finish_reason", "stop")
            choice["message"].setdefault("role", "assistant")
        usage = reply.get("usage")
        if isinstance(usage, dict):
            for name in ("prompt_tokens", "completion_tokens", "total_tokens"):
                usage.setdefault(name, 0)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return body
    return json.dumps({"id": "", "object": "chat.completion", "created": 0, "model": "", **reply}).encode()


async def ask(call: Call) -> tuple[str, int]:
    """The server's words and how many tokens they have. Time is the caller's matter."""
    transport = _Bounded(call.key)
    async with httpx2.AsyncClient(transport=transport, follow_redirects=False, timeout=None, trust_env=False) as http:
        client = AsyncOpenAI(
            base_url=call.url, api_key=call.key or _NO_KEY, max_retries=0, timeout=None, http_client=http
        )
        profile = OpenAIModelProfile(openai_chat_supports_max_completion_tokens=False, supports_json_schema_output=True)
        model = OpenAIChatModel(call.model, provider=OpenAIProvider(openai_client=client), profile=profile)
        settings = ModelSettings(temperature=0.0, max_tokens=call.most_tokens)
        response = await model_request(
            model, [_request(call)], model_settings=settings,
            model_request_parameters=_parameters(call.form), instrument=False,
        )  # fmt: skip
    return response.text or "", response.usage.output_tokens


def _request(call: Call) -> ModelRequest:
    if call.picture_png is None:
        return ModelRequest.user_text_prompt(call.prompt)
    picture = BinaryContent(data=call.picture_png, media_type="image/png")
    return ModelRequest(parts=[UserPromptPart(content=[call.prompt, picture])])


def told(error: Exception, model: str, address: str) -> DeviceError:
    """What went wrong, in our words: the client's may repeat what was sent.

    Args:
        error: what the client raised.
        model: the model's name.
        address: the variable that holds the server's address.
    """
    seen: BaseException | None = error
    while seen is not None:
        if isinstance(seen, _TooLongError):
            return DeviceError(f"language model server sent more than {MOST_BYTES} bytes: its answer was thrown away")
        seen = seen.__cause__ or seen.__context__
    status = error.status_code if isinstance(error, ModelHTTPError) else getattr(error.__cause__, "status_code", None)
    if status is not None:
        return DeviceError(
            f"language model server answered {status}: check key, address and the model's name '{model}'"
        )
    if isinstance(error, UnexpectedModelBehavior) or isinstance(error.__cause__, ValueError):
        return DeviceError(f"language model '{model}' sent no chat completion: check that {address} ends in /v1")
    if isinstance(error, ModelAPIError | httpx2.HTTPError | OSError):
        reason = type(error.__cause__ or error).__name__
        return DeviceError(f"language model server cannot be reached ({reason}): check {address}")
    return DeviceError(f"language model '{model}' sent no chat completion ({type(error).__name__}): check {address}")


def is_refused(error: Exception) -> bool:
    """Whether the server did not like what it was asked, as it does that knows no ``response_format``."""
    return isinstance(error, ModelHTTPError) and error.status_code in _REFUSALS


def _parameters(form: type[BaseModel] | None) -> ModelRequestParameters:
    if form is None:
        return ModelRequestParameters()
    name = form.__name__.strip("_")
    output = OutputObjectDefinition(json_schema=form.model_json_schema(), name=name, strict=False)
    return ModelRequestParameters(output_mode="native", output_object=output)
