"""What people say of their own mind: consent, refusal, doubt, delay. Tables only: class → phrases, split by bars."""

from __future__ import annotations

from mintpilot.language.answer_kinds import Kind

ATTITUDES: dict[Kind, str] = {
    Kind.YES: """
        yes|ys|yeah|yea|yep|yup|yah|yeh|yess|yse|ya|ye|aye|yessir|yes sir|yas|yip|affirmative|affirm|correct|exactly|
        precisely|true|ok|okey|okie dokie|alright|all right|roger|roger that|copy|copy that|confirmed|confirm|
        i confirm|i can confirm|i can confirm it|uh huh|mhm|mm hm|mmhmm|y|10 4|ten four|agreed|i agree|that is right|
        that is correct|that is true|you are right|you are correct|that is the one|that is it|that one|this one|
        that is what i mean|that is what i meant|that is the box|that is the person|that is what i want|
        that is what i wanted|you got it|you have got it|got it in one|bingo|spot on|right on|no doubt|without a doubt|
        no doubt about it|no question|no question about it|beyond doubt|could not agree more|i do not see why not|
        do not see why not|why not|no reason not to|no objection|no objections|why would it not be|you bet|you betcha|
        bet|very much so|hell yes|hell yeah|heck yes|thumbs up|it is the case|it sure is|it certainly is|that is a yes|
        say yes|i would say yes|answer is yes|the answer is yes|i said yes|you have clearance|clearance granted|
        i give you permission|i permit it|wilco|will do|do not see any reason not to|see no reason not to|
        can not see why not|by all means|granted|damn right|damn straight|too right|yes indeed|that is affirmative|
        positive|fine by me|fine with me|works for me|good by me|good with me|ok by me|ok with me|that works|
        sounds good|sounds good to me|sounds fine|looks good|looks good to me|looks fine|looks fine to me|very well|
        that is fine|that is good|that is ok|no complaints|it is|it does|i do|that is|bang on|dead on|dead right|
        mm hmm|could not be any other|could not be any other one|can not be any other|can not be any other one|
        the very one|the very same|that is what i said
    """,
    Kind.BOOST: """
        absolutely|definitely|certainly|surely|sure|sure thing|for sure|of course|totally|completely|indeed|obviously|
        clearly|perfectly|entirely|100|100 percent|hundred percent|a hundred percent|one hundred percent|without fail|
        undoubtedly|no two ways about it|i am sure|i am certain|i am positive|i am quite sure|i guarantee it|i promise|
        trust me|believe me|guaranteed|genuinely|truly|quite sure|very sure|absolutely sure
    """,
    Kind.NO: """
        nope|naw|nah|na|negative|nay|noo|nop|nada|nein|non|false|wrong|incorrect|n|uh uh|nuh uh|no way|no chance|
        can not open it|can not open that|can not open the door|no sir|no thanks|no thank you|not a chance|not a hope|
        not in a million years|not on your life|not on my watch|never ever|not now|not today|forget that|
        forget that one|leave that one|skip that one|forget this one|no good|nix|negatory|of course not|
        under no circumstances|by no means|hell no|heck no|no no|neither|neither one|neither of them|neither of those|
        none of them|none of these|none of those|none|other one|the other|another one|a different one|different one|
        some other one|another box|the other box|try another|i forbid it|i forbid that|forget it|forget about it|
        permission denied|denied|red light|thumbs down|that is a no|say no|i would say no|the answer is no|
        answer is no|i said no|out of the question|better not|rather not|best not|absolutely not|bad idea|a bad idea|
        terrible idea|mistake|bad call|bad move|wrong one|the wrong one|not even close|as if not|i do not think so|
        i do not believe so|do not think so|think not|i think not|i should think not|i do not reckon so|are you crazy|
        are you mad|are you insane|are you nuts|are you kidding|you must be joking|you must be kidding|
        have you lost your mind|are you out of your mind|are you serious|no siree|fat chance|over my dead body|
        do not do it|please do not|do not do that|do not you dare|do not even think about it|not recommended|
        not advisable|not advised|inadvisable|not worth it|not worth the risk|not a good idea|not such a good idea|
        veto|i refuse|refused|abstain from it|hard no|no no no|not happening|yeah no|god no|dear god no|heavens no|
        would not send
    """,
    Kind.AGREE: """
        go ahead|go quickly|go slowly|go carefully|go gently|go fast|go for it|go on|go right ahead|proceed|do it|
        do that|do so|please do|continue|carry on|keep going|go go|go go go|green light|you have permission|
        permission granted|you have my permission|good to go|good|fine|no problem|no problem at all|no problems|
        no issue|no issues|no worries|no bother|not a problem|no sweat|all good|all fine|all ok|you are good|
        you are fine|you are ok|you are all right|you may|you can|you should|you may proceed|take it|pick it|
        pick it up|grab it|get it|use it|be my guest|have at it|knock yourself out|full steam ahead|full speed ahead|
        let us go|let us do it|let us do that|let us go for it|move ahead|push ahead|press on|push on|onward|onwards|
        please go|just go|now go|go now|it is a go|that is a go|give it the green light|feel free|do not hesitate|
        can do|approved|i approve|cleared hot|advance|forward|head on|move on|roll on|send it|you are good to go|
        we are good to go|you can go|you may go|you should go
    """,
    Kind.MINIMISE: "just|only|merely|nothing but|nothing more than|simply|purely|mere",
    Kind.NOT: """
        not|never|without|knot|nto|ont|hardly|barely|nor|nothing like|anything but|far from|no longer|not any more|
        no more
    """,
    Kind.KNOW: """
        know|knows|tell|a clue|a clue about it|check|check it|check that|search|searched|searched it|look|say|remember|
        recall|see|hear|judge|understand|certain|see it|see that|see anything|tell you|seen|looked|been|checked|heard|
        decide|make out|make it out|guess|be sure|be certain|figure out|work out|verify|convinced|follow|catch that|
        catch|get that|on site|near there|the expert|an expert|informed|aware|confident|answer|saw|saw it|answer that|
        comment|positive about it|of knowing|of telling|to know|to tell|see a thing
    """,
    Kind.THINK: """
        think|guessing|leaning|leaning towards|believe|suppose|reckon|imagine|feel like|expect|assume|fancy|figure|
        would say|thinking|believe so|think so|suppose so|reckon so|guess so|i guess|i bet|my guess|hope|hope so|
        i hope|hoping|hopefully|bet|wish|thought|believed|assumed|in my opinion|imo|would have thought|would think|
        gut feeling|suspect|my hunch|hunch
    """,
    Kind.LIKELY: """
        probably|want to say|would like to say|supposed|supposed to be|that i know of|that i know|i know of|
        that i am aware of|potentially|likely|presumably|most likely|more than likely|very likely|quite likely|should|
        ought|seems|seem|seemingly|looks|looks like|look|looked like|looked|appears|appear|apparently|supposedly|
        allegedly|reportedly|pretty sure|fairly sure|almost sure|mostly sure|reasonably sure|fairly certain|
        pretty certain|almost certain|almost certainly|pretty much|more or less|kind of|kinda|sort of|sorta|
        as far as i know|afaik|as far as i can tell|as far as i can see|to my knowledge|last i heard|last i knew|
        last i checked|from what i|i was told|they told me|he told me|she told me|they said|he said|she said|
        somebody said|someone said|people say|they say|he says|she says|i heard that|i was informed|rumour|rumor|could|
        percent|odds|chances are|chance|tends to|usually|normally|generally|often|sometimes|mainly|in theory|
        theoretically|in principle|on paper|would be|somebody told me|someone told me|says|claims|claim|said it|
        according to|if i remember|from memory|ish|i would
    """,
    Kind.UNLIKELY: "unlikely|doubt|doubtful|doubts|i doubt|i doubt it|i doubt that|hardly any|very unlikely",
    Kind.SOFT: """
        halfway|half way|ajar|unlocked|fairly|pretty|relatively|reasonably|mostly|almost|nearly|quite|rather|somewhat|
        partly|partially|half|a bit|a little|slightly|safe enough|enough|particularly|especially|exactly|moderately|
        fully|less|more|not so
    """,
    Kind.VERY: "very|really|extremely|highly|super|so very|incredibly|terribly|damn|bloody|way|far|much|properly",
    Kind.UNSURE: """
        unconfirmed|unable|not able|
        metre|metres|meter|meters|width|foot|feet|wing|open it|open that|open the door|open them|how would i know|
        how should i know|who am i to say|how am i supposed to know|the faintest|foggiest|do not get it|did not get it|
        do not get that|did not get that|do not understand|am not there|am not here|was not there|are not there|
        were not there|am not near|am not in|am not at|not on site|not at the site|not nearby|maybe|perhaps|possibly|
        might|might be|could be|may be|unsure|uncertain|unclear|no idea|no clue|not a clue|not the foggiest|
        no information|no data|no news|no signal|no memory|no opinion|no comment|no way of knowing|no way of telling|
        no way to know|no way to tell|no means of knowing|no view|who knows|who can tell|who can say|god knows|
        heaven knows|lord knows|goodness knows|search me|beats me|you tell me|your guess|your guess is as good as mine|
        your choice|your call|your decision|up to you|you decide|you choose|you pick|you are the expert|it depends|
        depends|that depends|depending|yes and no|yes or no|fifty fifty|50 50|half and half|either|either one|
        either way|toss up|coin toss|a toss up|iffy|hard to say|hard to tell|hard to know|hard to see|hard to judge|
        hard to decide|difficult to say|difficult to tell|difficult to know|tough to say|tough call|tough one|hard one|
        tricky|tricky one|impossible to say|impossible to tell|impossible to know|good question|ask me later|
        ask me again|ask again|ask somebody else|ask someone else|ask later|ask someone|ask somebody|ask them|ask him|
        not my call|not my decision|not my job|do not ask me|do not know|do not care|do not mind|not care|not matter|
        makes no difference|no difference|whatever|whichever|whatever you like|whatever you think|suit yourself|
        as you like|as you wish|rain check|if you like|if you want|if you wish|if you must|so so|borderline|debatable|
        questionable|mixed|undecided|torn|on the fence|blank|forgot|forgotten|i forget|my mind is blank|skip|
        skip that question|next question|need to check|have to check|must check|better check|check first|
        check it first|we should check|go and see|go and look|have a look|take a look|go look|see for yourself|
        closer look|find out|check yourself|unknown|no telling|there is no telling|never mind|nevermind|blind here|
        lost track|confusing|confused|i am confused|missing information|negotiable|not necessarily|not that i know|
        not that i know of|not that i am aware|not to my knowledge|not as far as i know|not sure|not so sure|
        not certain|not clear to me|only just|just about|just fit|just barely|under the impression|inconclusive|
        stumped|clueless|wonder|pardon|huh|eh|come again|say again|say that again|say it again|say it once more|repeat|
        repeat that|please repeat|repeat the question|what was that|which one|did not catch that|once more|
        again please|one more time|excuse me|i beg your pardon|beg your pardon|speak up|louder|breaking up|
        you are breaking up|say what|sorry what|slow down|rephrase|in other words|i am lost|no reception|bad line|
        still checking|ambiguous|not make it out|leave it to you|leave that to you|leave it up to you|you should decide
    """,
    Kind.RISK: """
        risk it|risk that|chance it|take a chance|take the risk|take that risk|take the chance|take your chances|
        try it|try|give it a try|give it a go|give it a shot|worth a try|worth a shot|you can try|attempt it|gamble|
        gamble on it
    """,
    Kind.ELSEWHERE: """
        i am here|we are here|and you|i am listening|i heard you|i hear you|yes hello|speaking|we called|we have called|
        go ahead of|no problem with the|next|next room|the other room|next door|other room|upstairs|downstairs|
        left one|right one|on the left|on the right|to the left|to the right|the left|opposite|adjacent|neighbouring|
        another room|the other door|other door|second one|first one|right
    """,
    Kind.STALL: """
        wait|wait a moment|wait a second|wait a minute|wait a sec|wait a bit|hold on|hang on|one moment|one second|
        one sec|one minute|just a moment|just a second|just a minute|just a sec|a moment|a second|a minute|sec|moment|
        give me a second|give me a moment|give me a minute|give me a sec|get me a minute|stand by|standby|bear with me|
        let me check|let me see|let me think|let me look|let me ask|let me find out|hold up|two seconds|two minutes|
        let me have a look|let me take a look|i will check|i will ask|i am checking|checking|i need to think|
        thinking about it|need a minute|need a moment|need a second|need time|i will get back to you|
        i will come back to you|get back to you|call you back|not ready|later|in a minute|in a moment|in a second|
        on it|looking into it|hmm
    """,
    Kind.CONDITION: """
        if|unless|until|till|only if|only when|only for|only after|but|except|apart from|other than|as long as|
        provided|providing|when|once|after|before|though|although|however|assuming|while|whilst|in case|so long as|
        on condition|given that|whether|otherwise|or|or else|but only|except for|save for|as soon as|supposing|
        let alone|instead of
    """,
    Kind.PAST: """
        ago|a minute ago|a moment ago|a second ago|yesterday|last week|last month|last time|last night|earlier|
        this morning|used to be|used to|back then|previously|formerly|once was|last year|before that|at the time|
        when i left|had been|the other day|was|were
    """,
    Kind.MOCK: """
        shut up|you stupid|stupid drone|go away|leave me alone|yeah right|oh sure|oh yeah sure|right right|as if|
        in your dreams|dream on|pigs|pigs fly|death wish|genius|einstein|sherlock|brilliant|fantastic idea|great idea|
        wonderful idea|lovely idea|what could go wrong|what could possibly go wrong|good luck|good luck with that|
        say goodbye|kidding|just kidding|joking|just joking|joke|funny|very funny|haha|ha ha|hahaha|lol|lmao|rofl|
        lmfao|lose|lose another|sure jan|bonfire|barbecue|barbeque|bbq|roast|roasted|grill|kamikaze|hero|my ass|
        never come back|never return|my arse|
        said no one ever|said nobody ever|clear as mud|safe as houses|dandy|what a surprise|whoopee|
        because that always works|like a hole|famous last words|psych|sike|ironic|sarcasm|yeah nah|nah yeah|oh great|
        oh wonderful|oh perfect|oh brilliant|oh fantastic|just great|just perfect|just wonderful|just what we need|
        burn the drone|queen|king|pope|santa|father christmas|easter bunny|tooth fairy|napoleon|superman|fried|crispy|
        cremate|cremated|funeral|coffin|insurance|warranty|picnic
    """,
    Kind.DENIED: "nosuch",
    Kind.SUBJECT: "it|that|this|there|you|one|ones|these|those",
    Kind.PLACE: """
        the smoke|the way|the path|the area|the room|the door|smoke|cloud|room|door|area|path|passage|route|gate|
        corridor|hallway|doorway|place|air|stuff|thing
    """,
    Kind.PRONOUN: """
        i|we|he|she|they|who|my|our|his|where we|where i|
        where they|firemen|firefighters|fireman|caretaker|janitor|foreman|crew
    """,
    Kind.VERB: """
        is|are|was|were|has|have|had|does|did|do|can|will|would|should|be|been|being|am|may|must|shall|got|has got
    """,
    Kind.NOISE: """
        sorry|
        oh no|oh god|oh my god|yet|at all|no other way|no other choice|no choice|please|thank you|thanks|sir|madam|
        ma'am|mam|drone|well|oh|um|uh|er|erm|uhm|ah|hm|mm|ahem|so|then|now|really|careful|carefully|be careful|slow|
        slowly|gently|still|well then|and|the|a|an|to|me|my|for|of|go|take|mean|i mean|with|from|by|want|need|needed|
        at|all|hey|man|mate|buddy|dude|pal|friend|say|said|say so|too|also|on|as|your|his|her|its|our|their|them|us|
        him|here|right now|at the moment|currently|already|again|both|look|looks like|you know|you see|like|basically|
        actually|honestly|frankly|literally|seriously|in fact|to be honest|tbh|obviously|anyway|box|i said|i told you|
        told you|watch out|mind|hurry|hurry up|quick|quickly|fast|straight|through|over|up|down|along|back|around|away|
        off|into|out there|time|day|bit|little|big|any|anything|some more|more|much|because|since|checked|i checked|
        we checked|tested|been tested|verified|it has been|done|two|three|four|five|six|seven|eight|nine|ten|2|3|4|5|6|
        number|minutes|minute|hours|hour|today|ready|make|made|keep|let|let us|give|put|get|come|came|gone off|fly|
        flying|flew|drive|head|move|went|went in|walk|walked|walked through|went through|flew through|came through|
        pass through it|just been|end|else|even|next to|about|just now|not only|not just|fire is out|fire chief|
        fire brigade|fire department|fire service|fire officer|fire truck|fire marshal|fire alarm|fire door|fire exit|
        fire escape|fire extinguisher|fire crew|fire team|the fire team|fire is under control|put out|extinguished|
        no need|which|worry|do not worry|not to worry|not worry|hello|hi|ok so|such|at least|in|night|ma|watch|closer|
        nearer|near|right behind|right there|right here|right next to|right in front of|and no other|something awful|
        something terrible|something rotten|propped|wedged|kicked|forced|took|taken|easy|easily|ya|myself|meself|
        ourselves|yourself|whole|nothing else|nothing more|
        clear to me|clear on that|gap|big hole|huge hole|large hole|gaping hole|just a hole|standing|sitting|waiting|
        right across|fallen|love|dear|darling|chief|boss|guv
    """,
}
"""Class → phrases."""
